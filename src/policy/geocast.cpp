#include "policy/geocast.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "policy/detail/view.hpp"

namespace clearway::policy {
namespace {

using detail::LeaseWriter;
using detail::View;

constexpr char geocast_name[] = "geocast";

/// The lane of the present edge to clear; none inside a junction.
std::optional<std::uint32_t> cleared_lane(const View& view, const traffic::BelievedVehicle& emergency,
                                          ClearedLane wanted) {
    const roads::Edge& edge = view.network().edge(*view.edge_of(emergency));
    if (edge.internal) return std::nullopt;
    std::uint32_t cleared = view.lane_number(emergency);
    for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
        const bool is_farther = (wanted == ClearedLane::left && number > cleared) ||
                                (wanted == ClearedLane::right && number < cleared);
        if (is_farther && view.may_use_lane(emergency, number)) cleared = number;
    }
    return cleared;
}

/// The lane beside a lane that its vehicles move to: the outer one, or else the inner one; none if cars may
/// use neither.
std::optional<std::uint32_t> lane_beside(const roads::Network& network, core::LaneIndex lane) {
    const roads::Lane& own = network.lane(lane);
    const auto is_open = [&](std::uint32_t number) {
        return number < network.edge(own.edge).lane_count &&
               network.lane(network.lane_of(own.edge, number)).allows_cars;
    };
    if (own.number > 0 && is_open(own.number - 1)) return own.number - 1;
    if (is_open(own.number + 1)) return own.number + 1;
    return std::nullopt;
}

/// One message of an emergency vehicle.
class Message {
  public:
    Message(const View& view, const GeocastConfig& config, const traffic::BelievedVehicle& emergency,
            LeaseWriter& move, LeaseWriter& aside)
        : network_(view.network()),
          config_(config),
          emergency_(emergency),
          slow_mps_(static_cast<float>(config.slow_share * view.allowed_speed(emergency).value)),
          move_(move),
          aside_(aside) {}

    void clear(const roads::RouteStep& step) {
        const roads::Lane& lane = network_.lane(step.lane);
        if (network_.edge(lane.edge).internal) return;
        if (const auto beside = lane_beside(network_, step.lane))
            ask(move_, all_on(step, step.lane), traffic::ChangeLane{*beside}, "on the lane that is cleared");
        for (const std::uint32_t number : {lane.number - 1, lane.number + 1}) {  // 0 - 1 wraps round
            if (number < network_.edge(lane.edge).lane_count)
                ask(move_, all_on(step, network_.lane_of(lane.edge, number)), traffic::HoldLane{},
                    "stays off the lane that is cleared");
        }
        traffic::Stretch slow = all_on(step, step.lane);
        slow.to_m = std::min(slow.to_m, static_cast<float>(config_.aside_m) - step.start_m);
        slow.below_mps = slow_mps_;
        ask(aside_, slow, traffic::PullAside{}, "on the lane that is cleared");
    }

  private:
    /// From the emergency vehicle, or the start of the lane, to the reach, or the end of the lane.
    traffic::Stretch all_on(const roads::RouteStep& step, core::LaneIndex lane) const {
        const auto reach_m = static_cast<float>(config_.reach_m);
        return {.lane = lane,
                .from_m = std::max(0.0F, -step.start_m),
                .to_m = std::min(reach_m, step.end_m) - step.start_m,
                .addressed =
                    config_.ask_humans != 0 ? traffic::Addressed::drivers : traffic::Addressed::automated};
    }
    void ask(LeaseWriter& write, const traffic::Stretch& stretch, traffic::Action action,
             const char* reason) const {
        if (stretch.from_m < stretch.to_m) write.add(stretch, std::move(action), reason, emergency_.key);
    }

    const roads::Network& network_;
    const GeocastConfig& config_;
    const traffic::BelievedVehicle& emergency_;
    float slow_mps_;
    LeaseWriter &move_, &aside_;
};

}  // namespace

bool Geocast::is_due(core::Seconds now) const {
    const double now_s = now.value + core::clock_tolerance_s;
    return std::floor(now_s / config_.interval_s) >
           std::floor((now_s - context_.period.value) / config_.interval_s);
}

void Geocast::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const View view(context_.network, belief);
    LeaseWriter own(geocast_name, context_.period, belief.time, leases);
    LeaseWriter move(geocast_name, context_.period, belief.time, leases, config_.lease_s);
    LeaseWriter aside(geocast_name, context_.period, belief.time, leases, config_.lease_s,
                      detail::aside_priority);
    std::vector<roads::RouteStep> steps;
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        traffic::MotionState start = emergency.state;
        if (const auto number = cleared_lane(view, emergency, config_.lane)) {
            if (*number != view.lane_number(emergency))
                own.add(emergency.key, traffic::ChangeLane{*number}, "the lane that is cleared",
                        emergency.key);
            start.lane = view.network().lane_of(*view.edge_of(emergency), *number);
        }
        if (!is_due(belief.time)) continue;
        roads::lanes_ahead(view.network(), view.route_of(emergency.key), start, core::Metres(config_.reach_m),
                           steps);
        Message message(view, config_, emergency, move, aside);
        for (const roads::RouteStep& step : steps)
            message.clear(step);
    }
}

}  // namespace clearway::policy
