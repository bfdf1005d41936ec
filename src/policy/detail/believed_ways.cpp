#include "policy/detail/believed_ways.hpp"

#include <algorithm>
#include <span>

#include "core/error.hpp"
#include "core/random.hpp"
#include "policy/navigate.hpp"
#include "roads/exits.hpp"

namespace clearway::policy::detail {
namespace {

/// The times that the prior asks for. Throws core::InputError where the scenario has none.
std::span<const double> usual_times(const PolicyContext& context, Prior prior) {
    if (prior == Prior::free_flow) return {};
    if (context.mean_times_s.empty())
        throw core::InputError({"navigate.prior", "is mean_times, and the scenario names none",
                                "free_flow, or a scenario with network.mean_times",
                                "`clearway scenario mean-times SCENARIO --out FILE` makes them"});
    return context.mean_times_s;
}

/// Of a way from the vehicle on: the share of the length of its edges that lies on the present way.
double common_share(const roads::Network& network, roads::Route way, roads::Route present, double first_m) {
    double all_m = 0.0, common_m = 0.0;
    for (std::size_t at = 0; at < way.size(); ++at) {
        const double length_m = at == 0 ? first_m : static_cast<double>(network.edge(way[at]).length_m);
        all_m += length_m;
        if (core::contains(present, way[at])) common_m += length_m;
    }
    return all_m > 0.0 ? common_m / all_m : 1.0;
}

/// Every road stands for another one, drawn once for a network.
std::vector<core::EdgeIndex> mixed_up(const roads::Network& network) {
    std::vector<core::EdgeIndex> drawn;
    for (std::uint32_t row = 0; row < network.edges().size(); ++row)
        if (!network.edges()[row].internal) drawn.push_back({row});
    std::ranges::sort(drawn, {}, [](core::EdgeIndex edge) { return core::mix64(edge.value + 1); });
    std::vector<core::EdgeIndex> taken_for(network.edges().size());
    for (std::size_t row = 0; row < drawn.size(); ++row)
        taken_for[drawn[row].value] = drawn[(row + 1) % drawn.size()];
    return taken_for;
}

}  // namespace

BelievedWays::BelievedWays(const PolicyContext& context, const NavigateConfig& config)
    : network_(context.network),
      period_(context.period),
      observes_(config.observes != 0),
      heeds_incidents_(config.heeds_incidents != 0),
      search_(context.network, roads::Driver::emergency),
      times_(context.network, search_,
             {.fade_s = config.fade_s,
              .prior_s = config.prior_s,
              .signal_share = config.signal_share,
              .are_asked = config.waits == Waits::requested,
              .mean_times_s = usual_times(context, config.prior)}) {
    constexpr int spoiled = 2;
    if (config.observes == spoiled) taken_for_ = mixed_up(context.network);
}

bool BelievedWays::see(const traffic::BelievedGraph& belief) {
    if (!taken_for_.empty())
        see_spoiled(belief);
    else if (observes_)
        times_.see(belief, period_);
    const bool has_news = heeds_incidents_ && belief.incidents != known_;
    if (has_news) known_ = belief.incidents;
    return has_news;
}

void BelievedWays::see_spoiled(const traffic::BelievedGraph& belief) {
    times_.turn_to(belief.time);
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
        if (vehicle.vehicle_class == traffic::VehicleClass::emergency || !vehicle.state.lane.exists())
            continue;
        const core::EdgeIndex edge = taken_for_[network_.lane(vehicle.state.lane).edge.value];
        if (edge.exists()) times_.add(network_.lane_of(edge, 0), vehicle.state.speed_mps, period_);
    }
}

double BelievedWays::open_s(core::EdgeIndex edge, double entered_s, double pace) const {
    const double believed_s = times_.at(edge, entered_s, pace);
    const auto found = std::ranges::find(known_, edge, &traffic::KnownIncident::edge);
    const bool is_limited = found != known_.end() && found->speed_past_mps > 0.0F;
    return is_limited ? std::max<double>(believed_s, network_.edge(edge).length_m / found->speed_past_mps)
                      : believed_s;
}

std::optional<BelievedWays::Choice> BelievedWays::choice_of(const View& view,
                                                            const traffic::BelievedVehicle& emergency) const {
    const traffic::MotionState& state = emergency.state;
    const traffic::VehicleInfo& info = view.info_of(emergency);
    const roads::Route route = view.route_of(emergency.key);
    const roads::Lane& lane = network_.lane(state.lane);
    const double pace = std::max(1.0F, info.speed_factor);
    const double left_m = std::max(0.0F, lane.length_m - state.lane_position_m);
    const double braking_m = state.speed_mps * state.speed_mps / (2.0 * info.deceleration_mps2);
    const bool is_inside = network_.edge(lane.edge).internal;
    const double pace_mps = std::max(0.1, static_cast<double>(lane.speed_limit_mps) * pace);
    Choice choice;
    choice.before = {route[state.route_edge]};
    choice.trip.leaving_s = left_m / pace_mps;
    choice.trip.pace = pace;
    const bool is_late = is_inside || left_m < braking_m + roads::turn_room_m;
    if (is_late && state.route_edge + 1 < route.size()) {
        const core::EdgeIndex next = route[state.route_edge + 1];
        // Before a closed road a turn is tried even late: who stands at the line can still make it.
        if (is_inside || !is_closed(next)) {
            choice.before.push_back(next);
            choice.trip.leaving_s += times_.at(next, choice.trip.leaving_s, pace);
        }
    }
    const std::size_t at = state.route_edge + choice.before.size() - 1;
    if (at + 1 >= route.size() || roads::passes_its_end(route.subspan(at))) return std::nullopt;
    choice.trip.from = choice.before.back();
    choice.trip.to = route.back();
    choice.present = route.subspan(at);
    return choice;
}

std::vector<core::EdgeIndex> BelievedWays::whole(const Choice& choice, roads::Route way) {
    std::vector<core::EdgeIndex> edges = choice.before;
    edges.insert(edges.end(), way.begin() + 1, way.end());
    return edges;
}

OfferedWay BelievedWays::offer(const View& view, const traffic::BelievedVehicle& emergency,
                               const Choice& choice, roads::Route way) const {
    OfferedWay offered;
    offered.edges = whole(choice, way);
    offered.time_s = search_.time_of(way, choice.trip.leaving_s, edge_times_of(choice.trip));
    traffic::MotionState state = emergency.state;
    const roads::Route present = view.route_of(emergency.key).subspan(state.route_edge);
    state.route_edge = 0;  // where the offered way begins
    offered.length_m = roads::distance_to_end(network_, offered.edges, state).value;
    const roads::Lane& lane = network_.lane(state.lane);
    const bool is_inside = network_.edge(lane.edge).internal;
    const double first_m = is_inside ? 0.0 : std::max(0.0F, lane.length_m - state.lane_position_m);
    offered.common_share = common_share(network_, offered.edges, present, first_m);
    return offered;
}

std::vector<OfferedWay> BelievedWays::offers(const View& view, const traffic::BelievedVehicle& emergency,
                                             std::size_t count) {
    std::vector<OfferedWay> offered;
    const std::optional<Choice> choice = choice_of(view, emergency);
    if (!choice) return offered;
    for (const std::vector<core::EdgeIndex>& way :
         search_.ways(choice->trip, edge_times_of(choice->trip), count))
        offered.push_back(offer(view, emergency, *choice, way));
    std::ranges::stable_sort(offered, {}, &OfferedWay::time_s);
    return offered;
}

}  // namespace clearway::policy::detail
