#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/class_access.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Problems that a message names of one kind; the others are like them.
constexpr std::size_t named_problems = 20;

/// Takes out the vehicles that cannot drive as they say, over edges that the network has, that join and that
/// their class may use, with stops on them that `additional`, the elements of additional files, know; counts
/// them in `left_out`. Answers them as problems, up to `named_problems` and one
/// of a flow, for who refuses them.
std::vector<core::Problem> take_out_bad_vehicles(Demand& demand, const roads::Network& network,
                                                 const ClassAccess& access,
                                                 const std::vector<Element>& additional, LeftOut& left_out);

/// Finds a way for every trip, with duarouter: the fastest at free flow that the trip's type may use, over
/// the edges of its stops. `additional` are the elements of additional files, with the stops and zones that
/// trips name. Trips without any way are left out, as SUMO does with option ignore-route-errors.
void find_ways(Import& import, Demand& demand, const std::filesystem::path& network_file,
               const std::vector<Element>& additional);

}  // namespace clearway::scenario_import::detail
