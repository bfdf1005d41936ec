#pragma once

#include <filesystem>
#include <vector>

#include "city/detail/demand_reader.hpp"
#include "roads/network.hpp"

namespace clearway::city::detail {

/// Finds a way for every trip, with duarouter (the fastest at free flow that the trip's type may use), and
/// checks the ways of the others: edges that the network has and that join. `network_file` is that of
/// `network`; `folder` takes working files. Vehicles that cannot drive are refused together by
/// core::InputError, or left out and counted, as `bad_vehicles` says; trips without any way are left out in
/// either case, as SUMO does with option ignore-route-errors.
void find_ways(Demand& demand, const roads::Network& network, const std::filesystem::path& network_file,
               BadVehicles bad_vehicles, LeftOut& left_out, const std::filesystem::path& folder,
               const OnProgress& on_progress);

}  // namespace clearway::city::detail
