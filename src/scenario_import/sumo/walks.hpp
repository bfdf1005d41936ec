#pragma once

#include <filesystem>
#include <vector>

#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Gives walks that have only ends the edges of the shortest walking route, with duarouter. Persons with a
/// walk that has no route are left out. `network_file` is the file of `network`.
void find_walks(Import& import, std::vector<Person>& persons, const roads::Network& network,
                const std::filesystem::path& network_file);

}  // namespace clearway::scenario_import::detail
