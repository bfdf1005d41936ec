#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"
#include "scenario_import/detail/context.hpp"
#include "scenario_import/sumo/class_access.hpp"
#include "scenario_import/sumo/demand_reader.hpp"

namespace clearway::scenario_import::detail {

/// Most problems of one kind that a message names.
constexpr std::size_t named_problems = 20;

/// Removes the vehicles that cannot drive as the files say and counts them in `left_out`: all edges must
/// exist, join and be open to their class, and stops must lie on them and be defined in `additional`, the
/// elements of additional files. Returns them as problems, up to `named_problems` and one per flow.
std::vector<core::Problem> take_out_bad_vehicles(Demand& demand, const roads::Network& network,
                                                 const ClassAccess& access,
                                                 const std::vector<Element>& additional, LeftOut& left_out);

/// Gives trips without origin or destination the ends that SUMO takes: their first and last via or stop, or
/// the one edge that they name. Removes those with neither and counts them in `left_out`.
void complete_trips(Demand& demand, const std::vector<Element>& additional, LeftOut& left_out);

/// Finds a route for every trip with duarouter: the fastest at free flow that the trip's type may use, over
/// the edges of its stops. `additional` are the elements of additional files, with the stops and zones that
/// trips name. Trips without a route are left out, as SUMO does with the option ignore-route-errors.
void find_ways(Import& import, Demand& demand, const std::filesystem::path& network_file,
               const std::vector<Element>& additional);

}  // namespace clearway::scenario_import::detail
