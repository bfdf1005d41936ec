#include "policy/hold_cross.hpp"

#include <algorithm>
#include <set>

#include "policy/detail/approach.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy {
namespace {

/// Lanes whose way conflicts with the approach and does not have to wait at red.
std::set<core::LaneIndex> crossing_lanes(const detail::View& view, const detail::Approach& approach) {
    const roads::Signal& signal = view.network().signal(approach.signal);
    const std::string& shown = view.belief().signals.state[approach.signal.value];
    std::set<core::LaneIndex> lanes;
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        const bool stands = link < shown.size() && (shown[link] == 'r' || shown[link] == 'u');
        const bool crosses = std::ranges::any_of(approach.own_links,
                                                 [&](std::uint16_t own) { return signal.foes[link][own]; });
        if (stands || !crosses || signal.crossings[link]) continue;
        for (const roads::SignalLink& way : signal.links[link])
            lanes.insert(way.from);
    }
    return lanes;
}

}  // namespace

void HoldCross::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("hold_cross", context_.period, belief.time, leases, config_.lease_s);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const Audience audience(belief, emergency.key, config_);
        const double speed_mps = std::max<double>(emergency.state.speed_mps, config_.slowest_mps);
        for (const detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.horizon_m))) {
            if (approach.distance_m / speed_mps > config_.lead_s) break;
            const std::set<core::LaneIndex> lanes = crossing_lanes(view, approach);
            for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
                if (!audience.has(vehicle) || !lanes.contains(vehicle.state.lane)) continue;
                const double to_line_m =
                    view.network().lane(vehicle.state.lane).length_m - vehicle.state.lane_position_m;
                if (to_line_m <= config_.near_m)
                    write.add(vehicle.key, traffic::StopAtLine{}, "an emergency vehicle crosses",
                              emergency.key);
            }
        }
    }
}

}  // namespace clearway::policy
