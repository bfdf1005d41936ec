#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy::detail {

/// A signal that an emergency vehicle will pass.
struct Approach {
    core::SignalIndex signal;
    double distance_m = 0.0;               ///< To the first stop line of the signal.
    std::vector<std::uint16_t> own_links;  ///< Links that the emergency vehicle itself may take, ascending.
    /// `own_links` and all other links of its approaches that do not conflict with them, ascending: a
    /// left-turner ahead that has to wait would hold the emergency vehicle up.
    std::vector<std::uint16_t> links;
};

/// Signals ahead of `vehicle` within `horizon`, nearest first. Successive stop lines of one signal (joined
/// junctions) are one approach.
std::vector<Approach> approaches(const View& view, const traffic::BelievedVehicle& vehicle,
                                 core::Metres horizon);

/// A piece of the way ahead, by distances from the vehicle.
struct Piece {
    double from_m = 0.0;
    double to_m = 0.0;
};
/// Number of vehicles slower than `halted_mps` on a piece of the way to a stop line: on each edge those of
/// the lane with the most, summed over edges.
std::size_t queue_ahead(const View& view, const traffic::BelievedVehicle& vehicle, const Piece& piece,
                        double halted_mps);

/// Time to drive `distance_m` along the route at the allowed speed on each edge, s.
double free_travel_time_s(const View& view, const traffic::BelievedVehicle& vehicle, double distance_m);

}  // namespace clearway::policy::detail
