#include "policy/red_privilege.hpp"

#include <algorithm>

#include "policy/detail/approach.hpp"
#include "traffic/passing_red.hpp"

namespace clearway::policy {

void RedPrivilege::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("red_privilege", context_.period, belief.time, leases, config_.lease_s);
    const auto shows_red = [&](const detail::Approach& approach) {
        return traffic::holds_back(belief.signals.state[approach.signal.value], approach.own_links);
    };
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const auto ahead = detail::approaches(view, emergency, core::Metres(config_.near_m));
        const auto red = std::ranges::find_if(ahead, shows_red);
        if (red == ahead.end()) continue;
        write.add(emergency.key, traffic::PassRed{}, "a red signal ahead", emergency.key);
        const double speed_mps =
            traffic::speed_before_line(config_.passing_mps, config_.braking_mps2, red->distance_m);
        if (speed_mps < view.allowed_speed(emergency).value)
            write.add(emergency.key, traffic::DriveAt{core::MetresPerSecond(speed_mps)},
                      "slows down for a red signal", emergency.key);
    }
}

}  // namespace clearway::policy
