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

/// A unit and the name of its files: `city-0007-standard`.
struct PlannedUnit {
    std::string name;
    experiment::RunJob unit;
};

/// Where a unit stands in a study. `scenario` is a row of the manifest's scenarios.
struct UnitPlace {
    std::size_t scenario = 0;
    std::uint32_t replication = 0;
    experiment::TrafficModel traffic_model = experiment::TrafficModel::standard;
};
/// All units of a study in their order: replications first, so that an interrupted study has whole
/// replications of every scenario.
std::vector<UnitPlace> units_of(const results::Manifest& manifest);

/// What a study consists of. A pure function of configuration and versions.
struct Plan {
    results::Manifest manifest;
    std::vector<scenario::ScenarioConfig> scenarios;
    std::vector<PlannedUnit> units;  ///< In the order of `units_of`; all, or those of a shard.

    /// Of `units`.
    std::size_t run_count() const;
};

struct Versions {
    std::string clearway;
    std::string sumo;
};

/// Throws core::InputError when scenarios or conditions share a name, when there are none, or when a
/// condition with a policy has no baseline of its traffic model. `folder` becomes the units' output.
Plan make_plan(const StudyConfig& config, const Versions& versions, const std::filesystem::path& folder);

/// Makes the run folder: manifest, each scenario's effective configuration and network. What is there already
/// is kept. Throws as scenario::build_network and results::Store::create do.
results::Store prepare_folder(const Plan& plan, const std::filesystem::path& folder);

}  // namespace clearway::study
