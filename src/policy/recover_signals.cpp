#include "policy/recover_signals.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "policy/detail/approach.hpp"
#include "policy/detail/room.hpp"
#include "roads/short_loops.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy {
namespace {

using DemandByLane = std::unordered_map<std::uint32_t, int>;

/// Vehicles that a green would serve now, by lane: those that stand and those close to the end of their lane.
DemandByLane demand_by_lane(const roads::Network& network, const traffic::BelievedGraph& belief,
                            const RecoverSignalsConfig& config) {
    DemandByLane demand;
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
        if (!vehicle.state.lane.exists()) continue;
        const double left_m = network.lane(vehicle.state.lane).length_m - vehicle.state.lane_position_m;
        if (vehicle.state.speed_mps < config.halted_mps || left_m < config.close_m)
            ++demand[vehicle.state.lane.value];
    }
    return demand;
}

/// The links of a phase that have demand, and how much.
struct Served {
    std::vector<std::uint16_t> links;
    int vehicles = 0;
};

/// What waits, and whether there is room for it behind the signals.
struct Demand {
    DemandByLane by_lane;
    std::optional<detail::Room> room;
    double exit_room_m = 0.0;

    bool may_leave(const roads::SignalLink& way) const {
        return !room || !room->is_blocked({way}, exit_room_m);
    }
};

Served served_by(const roads::Signal& signal, const std::string& state, const Demand& demand) {
    Served served;
    std::vector<std::uint32_t> lanes;  // Few.
    for (std::uint16_t link = 0; link < signal.links.size() && link < state.size(); ++link) {
        if (!traffic::is_green(state[link])) continue;
        bool has_demand = false;
        for (const roads::SignalLink& way : signal.links[link]) {
            const auto found = demand.by_lane.find(way.from.value);
            if (found == demand.by_lane.end() || !demand.may_leave(way)) continue;
            has_demand = true;
            if (std::ranges::find(lanes, way.from.value) == lanes.end()) served.vehicles += found->second;
            lanes.push_back(way.from.value);
        }
        if (has_demand) served.links.push_back(link);
    }
    return served;
}

/// The links with demand of the phase that serves the most vehicles; empty when none wait. The present phase
/// counts `worth` vehicles more, because a change costs time.
std::vector<std::uint16_t> most_wanted(const roads::Signal& signal, const std::string& shown,
                                       const Demand& demand, int worth) {
    Served best;
    for (const roads::Phase& phase : signal.program) {
        Served served = served_by(signal, phase.state, demand);
        if (served.vehicles > 0 && phase.state == shown) served.vehicles += worth;
        if (served.vehicles > best.vehicles) best = std::move(served);
    }
    return best.links;
}

}  // namespace

RecoverSignals::RecoverSignals(const PolicyContext& context, RecoverSignalsConfig config)
    : ConfiguredPolicy(context, config) {
    if (config_.short_block_m > 0.0)
        keeps_cycle_ = roads::on_short_loops(context_.network, config_.short_block_m);
}

void RecoverSignals::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("recover_signals", context_.period, belief.time, leases, config_.lease_s);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        for (const detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.near_m))) {
            const bool is_free = keeps_cycle_.empty() || !keeps_cycle_[approach.signal.value];
            if (is_free) until_s_[approach.signal] = belief.time.value + config_.lasting_s;
        }
    }
    std::erase_if(until_s_, [&](const auto& entry) { return entry.second <= belief.time.value; });
    if (until_s_.empty()) return;
    Demand demand{demand_by_lane(context_.network, belief, config_), std::nullopt, config_.exit_room_m};
    if (config_.exit_room_m > 0.0) demand.room.emplace(context_.network, belief, config_.halted_mps);
    for (const auto& [signal, until] : until_s_) {
        std::vector<std::uint16_t> links =
            most_wanted(context_.network.signal(signal), belief.signals.state[signal.value], demand,
                        config_.change_vehicles);
        if (!links.empty())
            write.add(signal, traffic::AdjustGreen{std::move(links)}, "waited for an emergency vehicle", {});
    }
}

}  // namespace clearway::policy
