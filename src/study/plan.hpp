#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "results/manifest.hpp"
#include "results/store.hpp"
#include "results/unit.hpp"
#include "study/config.hpp"

namespace clearway::study {

/// A unit and the name of its files: `city-0007-standard`.
struct PlannedUnit {
    std::string name;
    results::UnitSpec unit;
};

/// What a study consists of. A pure function of configuration and versions.
struct Plan {
    results::Manifest manifest;
    std::vector<scenario::ScenarioConfig> scenarios;
    /// Replications first, so that an interrupted study has whole replications of every scenario.
    std::vector<PlannedUnit> units;

    std::size_t run_count() const;
};

struct Versions {
    std::string clearway;
    std::string sumo;
};

/// Throws core::InputError when scenarios or conditions share a name, when there are none, or when a
/// condition with a policy has no baseline of its engine. `folder` becomes the units' output.
Plan make_plan(const StudyConfig& config, const Versions& versions, const std::filesystem::path& folder);

/// Makes the run folder: manifest, each scenario's effective configuration and network. What is there already
/// is kept. Throws as scenario::build_network and results::Store::create do.
results::Store prepare_folder(const Plan& plan, const std::filesystem::path& folder);

}  // namespace clearway::study
