#include "policy/recover_signals.hpp"

#include <algorithm>
#include <unordered_map>

#include "policy/detail/approach.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy {
namespace {

constexpr char part_name[] = "recover_signals";

using HaltedByLane = std::unordered_map<std::uint32_t, int>;

HaltedByLane halted_by_lane(const traffic::BelievedGraph& belief) {
    HaltedByLane halted;
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
        if (vehicle.state.lane.exists() && vehicle.state.speed_mps < detail::halted_mps)
            ++halted[vehicle.state.lane.value];
    }
    return halted;
}

/// The links with a queue of the phase that would serve most vehicles; empty when nobody stands.
std::vector<std::uint16_t> most_waited_for(const roads::Signal& signal, const HaltedByLane& halted) {
    std::vector<std::uint16_t> best;
    int most = 0;
    for (const roads::Phase& phase : signal.program) {
        std::vector<std::uint16_t> links;
        std::unordered_map<std::uint32_t, int> lanes;
        for (std::uint16_t link = 0; link < signal.links.size() && link < phase.state.size(); ++link) {
            if (!traffic::is_green(phase.state[link])) continue;
            bool has_queue = false;
            for (const roads::SignalLink& way : signal.links[link]) {
                const auto found = halted.find(way.from.value);
                if (found == halted.end()) continue;
                has_queue = true;
                lanes[way.from.value] = found->second;
            }
            if (has_queue) links.push_back(link);
        }
        int served = 0;
        for (const auto& [lane, count] : lanes)
            served += count;
        if (served > most) {
            most = served;
            best = std::move(links);
        }
    }
    return best;
}

}  // namespace

RecoverSignals::RecoverSignals(const PartContext& context, RecoverSignalsConfig config)
    : network_(context.network), config_(config) {}

void RecoverSignals::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(network_, belief);
    detail::LeaseWriter write(part_name, belief.time, leases);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        for (const detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.near_m))) {
            until_s_[approach.signal] = belief.time.value + config_.lasting_s;
        }
    }
    std::erase_if(until_s_, [&](const auto& entry) { return entry.second <= belief.time.value; });
    if (until_s_.empty()) return;
    const HaltedByLane halted = halted_by_lane(belief);
    for (const auto& [signal, until] : until_s_) {
        std::vector<std::uint16_t> links = most_waited_for(network_.signal(signal), halted);
        if (!links.empty())
            write.add(signal, traffic::FavourLinks{std::move(links)}, "waited for an emergency vehicle", {});
    }
}

}  // namespace clearway::policy
