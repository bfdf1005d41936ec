#include "policy/preempt_signals.hpp"

#include <algorithm>

#include "policy/detail/approach.hpp"

namespace clearway::policy {
namespace {

constexpr char policy_name[] = "preempt_signals";

}  // namespace

PreemptSignals::PreemptSignals(const PolicyContext& context, PreemptSignalsConfig config)
    : context_(context), config_(config) {}

void PreemptSignals::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write(policy_name, context_.period, belief.time, leases, config_.lease_s);
    std::set<std::pair<core::VehicleKey, core::SignalIndex>> asked;
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const double slowest_mps = config_.slowest_share * view.allowed_speed(emergency).value;
        const double speed_mps = std::max<double>(emergency.state.speed_mps, slowest_mps);
        for (const detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.horizon_m))) {
            const double arrival_s = approach.distance_m / std::max(speed_mps, 0.1);
            const auto halted = static_cast<double>(
                detail::queue_ahead(view, emergency, approach.distance_m, config_.halted_mps));
            const double lead_s =
                std::min(config_.lead_s + config_.lead_per_halted_s * halted, config_.longest_lead_s);
            const std::pair request{emergency.key, approach.signal};
            if (arrival_s > lead_s && !asked_.contains(request)) continue;
            asked.insert(request);
            write.add(approach.signal, traffic::HoldGreen{approach.links, approach.own_links},
                      "an emergency vehicle arrives", emergency.key);
        }
    }
    asked_ = std::move(asked);
}

}  // namespace clearway::policy
