#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "results/store.hpp"
#include "study/plan.hpp"

namespace clearway::study {

/// Writes what a report needs of each scenario of the plan beside its network: wide edges, counted flows,
/// street names and a picture. Also makes a first demand, which finds unknown edges and unreachable
/// destinations before any worker starts. What is there is kept. Throws core::InputError with the problems of
/// all scenarios.
void complete_scenarios(const Plan& plan, const results::Store& store);

/// Keeps the command that began the study, whatever continues it, unless that command extends it beyond the
/// replications that were there `before`.
void keep_command(const results::Store& store, const std::string& command, std::uint32_t before);

/// Copies what the trainings of models left, `NAME/{losses.csv,summary.json}` of `source`, for the report's
/// train-test curves. Throws core::EnvironmentError when it cannot write.
void copy_trainings(const std::filesystem::path& source, const results::Store& store);

}  // namespace clearway::study
