#include "policy/line_of_sight.hpp"

#include <cmath>
#include <numbers>

#include "policy/detail/approach.hpp"

namespace clearway::policy {
namespace {

/// A way is at most this much longer than the crow flies, so that signals on it are found.
constexpr double most_detour = 2.0;

/// Where the vehicle would stop at the signal.
roads::Point stop_line(const roads::Network& network, const detail::Approach& approach) {
    const roads::SignalLink& way = network.signal(approach.signal).links[approach.own_links.front()].front();
    return network.lane(way.from).shape.back();
}

bool is_in_beam(const traffic::MotionState& state, const roads::Point& target,
                const LineOfSightConfig& config) {
    const double across_m = target.x_m - state.x_m;
    const double along_m = target.y_m - state.y_m;
    if (std::hypot(across_m, along_m) > config.range_m) return false;
    const double off_rad =
        std::remainder(std::atan2(along_m, across_m) - state.heading_rad, 2.0 * std::numbers::pi);
    return std::abs(off_rad) <= config.half_angle_deg * std::numbers::pi / 180.0;
}

}  // namespace

void LineOfSight::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("line_of_sight", context_.period, belief.time, leases);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        for (const detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(most_detour * config_.range_m))) {
            if (is_in_beam(emergency.state, stop_line(context_.network, approach), config_))
                write.add(approach.signal, traffic::HoldGreen{approach.links, approach.own_links},
                          "in sight of an emergency vehicle", emergency.key);
        }
    }
}

}  // namespace clearway::policy
