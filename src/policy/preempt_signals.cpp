#include "policy/preempt_signals.hpp"

#include <algorithm>
#include <optional>

#include "policy/detail/approach.hpp"
#include "policy/detail/room.hpp"
#include "policy/detail/short_loops.hpp"

namespace clearway::policy {
namespace {

constexpr char policy_name[] = "preempt_signals";

/// Whether every way that the emergency vehicle may take ends at standing vehicles.
bool leads_into_a_queue(const roads::Signal& signal, const detail::Approach& approach,
                        const detail::Room& room, double least_m) {
    return std::ranges::all_of(
        approach.own_links, [&](std::uint16_t link) { return room.is_blocked(signal.links[link], least_m); });
}

}  // namespace

PreemptSignals::PreemptSignals(const PolicyContext& context, PreemptSignalsConfig config)
    : context_(context), config_(config) {
    if (config_.short_block_m > 0.0)
        is_careful_ = detail::on_short_loops(context_.network, config_.short_block_m);
}

void PreemptSignals::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write(policy_name, context_.period, belief.time, leases, config_.lease_s);
    std::set<std::pair<core::VehicleKey, core::SignalIndex>> asked;
    std::optional<detail::Room> room;
    if (!is_careful_.empty() && config_.exit_room_m > 0.0)
        room.emplace(context_.network, belief, config_.halted_mps);
    const auto stands_back = [&](const detail::Approach& approach, int number, bool is_asked) {
        if (is_careful_.empty() || !is_careful_[approach.signal.value]) return false;
        if (config_.signals_ahead > 0 && number > config_.signals_ahead) return true;
        return room && !is_asked &&
               leads_into_a_queue(context_.network.signal(approach.signal), approach, *room,
                                  config_.exit_room_m);
    };
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const double slowest_mps = config_.slowest_share * view.allowed_speed(emergency).value;
        const double speed_mps = std::max<double>(emergency.state.speed_mps, slowest_mps);
        int number = 0;
        for (const detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.horizon_m))) {
            const std::pair request{emergency.key, approach.signal};
            const bool is_asked = asked_.contains(request);
            if (stands_back(approach, ++number, is_asked)) continue;
            const double arrival_s = approach.distance_m / std::max(speed_mps, 0.1);
            const auto halted = static_cast<double>(
                detail::queue_ahead(view, emergency, approach.distance_m, config_.halted_mps));
            const double lead_s =
                std::min(config_.lead_s + config_.lead_per_halted_s * halted, config_.longest_lead_s);
            if (arrival_s > lead_s && !is_asked) continue;
            asked.insert(request);
            write.add(approach.signal, traffic::HoldGreen{approach.links, approach.own_links},
                      "an emergency vehicle arrives", emergency.key);
        }
    }
    asked_ = std::move(asked);
}

}  // namespace clearway::policy
