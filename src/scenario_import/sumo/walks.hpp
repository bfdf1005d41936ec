#pragma once

#include <filesystem>
#include <vector>

#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Gives walks that have only ends the edges of the shortest way on foot, with duarouter. Persons with a walk
/// that has none are left out. `network_file` is that of `network`.
void find_walks(Import& import, std::vector<Person>& persons, const roads::Network& network,
                const std::filesystem::path& network_file);

}  // namespace clearway::scenario_import::detail
