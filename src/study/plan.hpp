#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/run_job.hpp"
#include "results/manifest.hpp"
#include "results/store.hpp"
#include "study/config.hpp"

namespace clearway::study {

/// A unit and the base name of its files: `city-0007-standard`.
struct PlannedUnit {
    std::string name;
    experiment::RunJob unit;
};

/// Which unit of a study. `scenario` is an index into the manifest's scenarios.
struct UnitPlace {
    std::size_t scenario = 0;
    std::uint32_t replication = 0;
    experiment::ProcessOptions process = {};
};
/// All units of a study in the order of replications, so that an interrupted study has complete replications
/// of every scenario.
std::vector<UnitPlace> units_of(const results::Manifest& manifest);

/// What a study consists of; determined by configuration and versions alone.
struct Plan {
    results::Manifest manifest;
    std::vector<scenario::ScenarioConfig> scenarios;
    core::Settings titles = {};      ///< StudyConfig::titles; they change no run.
    core::Settings controls = {};    ///< StudyConfig::controls; likewise.
    std::string text = {};           ///< StudyConfig::text; likewise.
    std::vector<PlannedUnit> units;  ///< In the order of `units_of`; all, or those of a shard.

    /// Number of runs in `units`.
    std::size_t run_count() const;
};

struct Versions {
    std::string clearway;
    std::string sumo;
    std::string build = {};  ///< Of this program and its worker: core::build_stamp.
};

/// Its baselines alone, with other replications, under the name `NAME-baselines`: for analysis::adjust_by.
StudyConfig baselines_of(StudyConfig config, std::uint32_t replications);

/// What a study is, as its run folder keeps it.
results::Manifest manifest_of(const StudyConfig& config, const Versions& versions);

/// Throws core::InputError when scenarios or conditions share a name, when there are none, or when a
/// condition with a policy has no baseline with its traffic model. `folder` becomes the units' output.
Plan make_plan(const StudyConfig& config, const Versions& versions, const std::filesystem::path& folder);

/// Throws core::InputError with what the conditions need of the scenarios' roads and do not find there, such
/// as a shoulder or mean times of other days. Builds the networks of which a condition needs something, in
/// some seconds at most.
void check_roads(const Plan& plan);

/// What a run and its dry run both check before anything is made: check_roads, whether what a run folder
/// holds can be read, and core::require_writable. Writes nothing that stays.
void require_ready(const Plan& plan, const std::filesystem::path& folder);

/// Throws core::InputError for a scenario that the folder holds and that is not the manifest's any more, or
/// whose network was changed: a continued study never mixes two scenarios.
void require_unchanged(const results::Store& store);
/// Likewise for one scenario, in `folder`.
void require_unchanged(const results::ScenarioEntry& entry, const std::filesystem::path& folder);

/// Creates the run folder with the manifest and each scenario's effective configuration and network. Keeps
/// what already exists. Throws as require_ready, require_unchanged, scenario::build_network and
/// results::Store::create do.
results::Store prepare_folder(const Plan& plan, const std::filesystem::path& folder);

}  // namespace clearway::study
