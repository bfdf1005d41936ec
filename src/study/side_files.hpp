#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "results/store.hpp"
#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "study/plan.hpp"

namespace clearway::study {

/// Throws core::InputError for counted flows of a scenario that cannot be read or lie on edges that the
/// network does not have.
void check_counts(const scenario::ScenarioConfig& config, const roads::Network& network);

/// Writes what a report needs of each scenario besides its network: wide edges, counted flows, street names
/// and a picture. Also makes a first demand, which finds unknown edges and unreachable destinations before
/// any worker starts. Keeps what already exists. Throws core::InputError with the problems of all scenarios.
void complete_scenarios(const Plan& plan, const results::Store& store);

/// Whether a study has more replications or conditions than its folder had.
enum class Growth : std::uint8_t { none, more };
/// Stores the command that made the study: the first one, or a later one that extends it.
void keep_command(const results::Store& store, const std::string& command, Growth growth);

/// Stores titles for the report in place of earlier ones: `titles.json`, a text by name. Without titles there
/// is no such file.
void keep_titles(const results::Store& store, const core::Settings& titles);
/// The same for the conditions that are controls: `controls.json`.
void keep_controls(const results::Store& store, const core::Settings& controls);

/// Stores the text of the study file in place of an earlier one: `study.toml`. Without a text there is none.
void keep_study_file(const results::Store& store, const std::string& text);

/// Copies the outputs of trainings, `NAME/{losses.csv,summary.json}` in `source`, for the report's train-test
/// curves. Throws core::EnvironmentError when it cannot write.
void copy_trainings(const std::filesystem::path& source, const results::Store& store);

}  // namespace clearway::study
