#pragma once

#include <optional>

#include "core/ids.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy::detail {

/// Room for a vehicle between two others on a neighbouring lane, or ahead of the first or behind the last of
/// them.
struct Gap {
    double shift_m = 0.0;  ///< How far the vehicle must move relative to that lane's traffic to be alongside.
    /// Speed of the vehicle ahead of the gap, or else behind it, m/s; 0 on an empty lane.
    double flow_mps = 0.0;
    const traffic::BelievedVehicle* behind = nullptr;  ///< The vehicle behind the gap; null if none.
};

/// Headways that a lane change must leave, s.
struct Headways {
    double usual_s = 1.0;      ///< That of the Intelligent Driver Model.
    double automated_s = 0.5;  ///< To an automated vehicle behind, which is asked to make more room.
};

/// The nearest gap on `lane`, another lane of the edge of `vehicle`, that leaves minimum gap and headway on
/// both sides: behind at the follower's speed, ahead at the leader's, to which `vehicle` has adapted by then.
/// Empty when the lane has none. Vehicles on other edges are not considered.
std::optional<Gap> nearest_gap(const View& view, const traffic::BelievedVehicle& vehicle,
                               core::LaneIndex lane, const Headways& headways);

}  // namespace clearway::policy::detail
