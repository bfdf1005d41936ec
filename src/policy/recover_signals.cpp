#include "policy/recover_signals.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "policy/detail/room.hpp"
#include "policy/detail/view.hpp"
#include "roads/route.hpp"
#include "roads/short_loops.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy {
namespace {

/// Vehicles that a green would serve now, by lane: those that stand and those close to the end of their lane.
std::vector<int> demand_by_lane(const roads::Network& network, const traffic::BelievedGraph& belief,
                                const RecoverSignalsConfig& config) {
    std::vector<int> demand(network.lanes().size(), 0);
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
    std::vector<core::LaneIndex> lanes;  ///< That have it. Few.
    int vehicles = 0;

    Served() {
        constexpr std::size_t usual = 16;  // More are rare.
        links.reserve(usual);
        lanes.reserve(usual);
    }
};

/// What waits, and whether there is room for it behind the signals.
struct Demand {
    std::vector<int> by_lane;
    std::optional<detail::Room> room;
    double exit_room_m = 0.0;

    bool may_leave(const roads::SignalLink& way) const {
        return !room || !room->is_blocked({way}, exit_room_m);
    }
};

/// `served` is reused.
void find_served(const roads::Signal& signal, const std::string& state, const Demand& demand,
                 Served& served) {
    served.links.clear();
    served.lanes.clear();
    served.vehicles = 0;
    for (std::uint16_t link = 0; link < signal.links.size() && link < state.size(); ++link) {
        if (!traffic::is_green(state[link])) continue;
        bool has_demand = false;
        for (const roads::SignalLink& way : signal.links[link]) {
            const int waiting = demand.by_lane[way.from.value];
            if (waiting == 0 || !demand.may_leave(way)) continue;
            has_demand = true;
            if (core::contains(served.lanes, way.from)) continue;
            served.vehicles += waiting;
            served.lanes.push_back(way.from);
        }
        if (has_demand) served.links.push_back(link);
    }
}

/// The links with demand of the phase that serves the most vehicles; empty when none wait. The present phase
/// counts `worth` vehicles more, because a change costs time.
class MostWanted {
  public:
    const std::vector<std::uint16_t>& of(const roads::Signal& signal, const std::string& shown,
                                         const Demand& demand, int worth) {
        best_.links.clear();
        best_.vehicles = 0;
        for (const roads::Phase& phase : signal.program) {
            find_served(signal, phase.state, demand, served_);
            if (served_.vehicles > 0 && phase.state == shown) served_.vehicles += worth;
            if (served_.vehicles > best_.vehicles) std::swap(served_, best_);
        }
        return best_.links;
    }

  private:
    Served best_;
    Served served_;
};

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
        for (const roads::StopLine& line :
             roads::signals_ahead(context_.network, view.route_of(emergency.key), emergency.state,
                                  core::Metres(config_.near_m))) {
            const bool is_free = keeps_cycle_.empty() || !keeps_cycle_[line.signal.value];
            if (is_free) until_s_[line.signal] = belief.time.value + config_.lasting_s;
        }
    }
    std::erase_if(until_s_, [&](const auto& entry) { return entry.second <= belief.time.value; });
    if (until_s_.empty()) return;
    Demand demand{demand_by_lane(context_.network, belief, config_), std::nullopt, config_.exit_room_m};
    if (config_.exit_room_m > 0.0) demand.room.emplace(context_.network, belief, config_.halted_mps);
    MostWanted most_wanted;
    for (const auto& [signal, until] : until_s_) {
        const std::vector<std::uint16_t>& links =
            most_wanted.of(context_.network.signal(signal), belief.signals.state[signal.value], demand,
                           config_.change_vehicles);
        if (!links.empty())
            write.add(signal, traffic::AdjustGreen{links}, "waited for an emergency vehicle", {});
    }
}

}  // namespace clearway::policy
