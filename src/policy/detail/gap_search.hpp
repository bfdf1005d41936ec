#pragma once

#include <optional>

#include "core/ids.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy::detail {

/// Room for a vehicle between two others on a neighbouring lane, or before the first or behind the last of
/// them.
struct Gap {
    double shift_m = 0.0;  ///< How far the vehicle must move relative to that lane's traffic to be beside it.
    /// Speed of that traffic, of who drives before the gap, else behind it, m/s; 0 on an empty lane.
    double flow_mps = 0.0;
    const traffic::BelievedVehicle* behind = nullptr;  ///< Who drives behind it, if anybody.
};

/// Headways that a change of lanes leaves, s.
struct Headways {
    double usual_s = 1.0;      ///< As the Intelligent Driver Model's.
    double automated_s = 0.5;  ///< Before an automated vehicle, which is asked for more.
};

/// The nearest gap on `lane`, which lies beside `vehicle` on the same edge, that leaves minimum gap and
/// headway to both sides: behind at the follower's speed, before at the leader's, taken on by then. Nothing
/// when the lane has none. Vehicles of other edges are not seen.
std::optional<Gap> nearest_gap(const View& view, const traffic::BelievedVehicle& vehicle,
                               core::LaneIndex lane, const Headways& headways);

}  // namespace clearway::policy::detail
