#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "city/detail/context.hpp"

namespace clearway::city::detail {

/// Files of SUMO with demand, and what goes with it.
struct SumoFiles {
    std::vector<std::filesystem::path> routes;
    std::vector<std::filesystem::path> additional;
    std::optional<double> begin_s;
    std::optional<double> end_s;
};

/// Turns them into the measured demand of `config`: traffic.rou.xml (one vehicle each, sorted, times from the
/// scenario's begin), types.add.xml, additional.add.xml and persons.rou.xml in the scenario's folder. False,
/// and nothing done, when there is no vehicle in them. Throws core::InputError for demand that cannot be
/// used.
bool add_sumo_demand(Import& import, const SumoFiles& files, const roads::Network& network,
                     const std::filesystem::path& network_file, scenario::ScenarioConfig& config);

}  // namespace clearway::city::detail
