#include "policy/navigate.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "roads/route.hpp"

namespace clearway::policy {
namespace {

/// A way is asked for so long at most, s: enough to leave a junction. Later the crew may have turned.
constexpr double longest_lease_s = 5.0;

bool is_known_closed(const std::vector<traffic::KnownIncident>& incidents, core::EdgeIndex edge) {
    return std::ranges::any_of(incidents, [&](const traffic::KnownIncident& incident) {
        return incident.edge == edge && incident.closed_to_emergency;
    });
}

/// The times that the prior asks for. Throws core::InputError where the scenario has none.
std::span<const double> usual_times(const PolicyContext& context, Prior prior) {
    if (prior == Prior::free_flow) return {};
    if (context.mean_times_s.empty())
        throw core::InputError({"navigate.prior", "is mean_times, and the scenario names none",
                                "free_flow, or a scenario with network.mean_times",
                                "`clearway scenario mean-times SCENARIO --out FILE` makes them"});
    return context.mean_times_s;
}

}  // namespace

Navigate::Navigate(const PolicyContext& context, const NavigateConfig& config)
    : ConfiguredPolicy(context, config),
      search_(context.network, roads::Driver::emergency),
      times_(context.network, search_,
             {.fade_s = config.fade_s,
              .prior_s = config.prior_s,
              .signal_share = config.signal_share,
              .mean_times_s = usual_times(context, config.prior)}) {}

void Navigate::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    if (config_.observes != 0) times_.see(belief, context_.period);
    const bool has_news = config_.heeds_incidents != 0 && belief.incidents != known_;
    if (has_news) known_ = belief.incidents;
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("navigate", context_.period, belief.time, leases,
                              std::min(config_.replan_s, longest_lease_s));
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const auto [planned, is_new] = planned_at_.try_emplace(emergency.key, belief.time.value);
        const double age_s = belief.time.value - planned->second;
        if (!is_new && !has_news && age_s + core::clock_tolerance_s < config_.replan_s) continue;
        planned->second = belief.time.value;
        plan(view, emergency, write);
    }
}

Navigate::Fork Navigate::fork_of(const detail::View& view, const traffic::BelievedVehicle& emergency,
                                 double pace) const {
    const traffic::MotionState& state = emergency.state;
    const roads::Route route = view.route_of(emergency.key);
    const roads::Lane& lane = context_.network.lane(state.lane);
    const double left_m = std::max(0.0F, lane.length_m - state.lane_position_m);
    const double braking_m =
        state.speed_mps * state.speed_mps / (2.0 * view.info_of(emergency).deceleration_mps2);
    const bool is_inside = context_.network.edge(lane.edge).internal;
    const double pace_mps = std::max(0.1, static_cast<double>(lane.speed_limit_mps) * pace);
    Fork fork{{route[state.route_edge]}, left_m / pace_mps};
    if (is_inside || left_m < braking_m + roads::turn_room_m) {
        if (state.route_edge + 1 < route.size()) {
            const core::EdgeIndex next = route[state.route_edge + 1];
            // Before a closed road a turn is tried even late: who stands at the line can still make it.
            if (!is_inside && is_known_closed(known_, next)) return fork;
            fork.before.push_back(next);
            fork.leaving_s += times_.at(next, fork.leaving_s, pace);
        }
    }
    return fork;
}

void Navigate::plan(const detail::View& view, const traffic::BelievedVehicle& emergency,
                    detail::LeaseWriter& write) {
    const roads::Route route = view.route_of(emergency.key);
    const traffic::VehicleInfo& info = view.info_of(emergency);
    const double pace = std::max(1.0F, info.speed_factor);
    const Fork fork = fork_of(view, emergency, pace);
    const std::size_t at = emergency.state.route_edge + fork.before.size() - 1;
    const core::EdgeIndex here = fork.before.back();
    if (at + 1 >= route.size() || roads::passes_its_end(route.subspan(at))) return;
    // Past an incident that leaves a lane open, no faster than its limit.
    const auto limited_s = [&](core::EdgeIndex edge) {
        const auto found = std::ranges::find(known_, edge, &traffic::KnownIncident::edge);
        const bool is_limited = found != known_.end() && found->speed_past_mps > 0.0F;
        return is_limited ? context_.network.edge(edge).length_m / found->speed_past_mps : 0.0;
    };
    const auto edge_s = [&](core::EdgeIndex edge, double entered_s) {
        // Who is called to a closed road goes there.
        if (edge != route.back() && is_known_closed(known_, edge)) return roads::no_way_s;
        return std::max(times_.at(edge, entered_s, pace), limited_s(edge));
    };
    const double found_s = search_.search({here, route.back(), fork.leaving_s, pace}, edge_s, way_);
    if (found_s == roads::no_way_s) return;
    const double present_s = search_.time_of(route.subspan(at), fork.leaving_s, edge_s);
    const double least_gain_s = std::max(config_.gain_s, config_.gain_share * present_s);
    const bool is_blocked = present_s == roads::no_way_s;
    if (!is_blocked && present_s - found_s <= least_gain_s) return;
    if (std::ranges::equal(way_, route.subspan(at))) return;
    traffic::TakeRoute way{fork.before};
    way.edges.insert(way.edges.end(), way_.begin() + 1, way_.end());
    write.add(emergency.key, std::move(way), is_blocked ? "its way is closed" : "another way is faster",
              emergency.key);
}

}  // namespace clearway::policy
