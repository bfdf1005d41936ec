#include "policy/green_wave.hpp"

#include <algorithm>

#include "policy/detail/approach.hpp"

namespace clearway::policy {
namespace {

/// Longer than any route, m.
constexpr double whole_route_m = 1e6;

}  // namespace

void GreenWave::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("green_wave", context_.period, belief.time, leases, config_.lease_s);
    const std::vector<traffic::BelievedVehicle> emergencies = view.emergency_vehicles();
    for (const traffic::BelievedVehicle& emergency : emergencies) {
        const auto [plan, is_new] = plans_.try_emplace(emergency.key);
        if (is_new) {
            for (detail::Approach& approach :
                 detail::approaches(view, emergency, core::Metres(whole_route_m))) {
                const double arrival_s =
                    belief.time.value + detail::free_travel_time_s(view, emergency, approach.distance_m);
                plan->second.push_back({approach.signal, std::move(approach.links),
                                        arrival_s - config_.before_s, arrival_s + config_.after_s});
            }
        }
        for (const Window& window : plan->second) {
            if (belief.time.value >= window.from_s && belief.time.value < window.until_s)
                write.add(window.signal, traffic::HoldGreen{window.links}, "planned arrival", emergency.key);
        }
    }
    std::erase_if(plans_, [&](const auto& plan) {
        return !std::ranges::binary_search(emergencies, plan.first, {}, &traffic::BelievedVehicle::key);
    });
}

}  // namespace clearway::policy
