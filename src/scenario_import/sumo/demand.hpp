#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"
#include "scenario_import/sumo/rerouting.hpp"

namespace clearway::scenario_import::detail {

/// SUMO files with demand, and their settings.
struct SumoFiles {
    std::vector<std::filesystem::path> routes;
    std::vector<std::filesystem::path> additional;
    std::optional<double> begin_s;
    std::optional<double> end_s;
    double scale = 1.0;  ///< SUMO's option: number of copies of each vehicle and person.
    Rerouting rerouting;
};

/// Turns them into the measured demand of `config`: traffic.rou.xml (single vehicles, sorted, times from the
/// scenario's begin), types.add.xml, additional.add.xml and persons.rou.xml in the scenario's folder. The
/// signal programs of `network_file` are shifted to that begin too. Returns false
/// when the files name no vehicle; then their signal programs go into the network, and all else that belongs
/// to it into additional.add.xml. Throws core::InputError for demand that cannot be used.
bool add_sumo_demand(Import& import, const SumoFiles& files, const roads::Network& network,
                     const std::filesystem::path& network_file, scenario::ScenarioConfig& config);

}  // namespace clearway::scenario_import::detail
