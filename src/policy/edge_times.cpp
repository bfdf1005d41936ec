#include "policy/edge_times.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::policy {
namespace {

/// Slower traffic is believed to move at this speed, m/s: a queue moves up.
constexpr double least_mps = 0.1;

/// From a request to green: yellow, clearance and what a controller may finish first; assumed.
constexpr double transition_s = 10.0;
/// Vehicles of a queue leave so far apart: a saturation flow of 1,800 vehicles an hour and lane.
constexpr double headway_s = 2.0;

bool is_green(char letter) {
    return letter == 'g' || letter == 'G';
}

/// Mean wait at a link of a program for arrivals at any time, s: the sum of red^2 / 2 over the reds of a
/// cycle, divided by the cycle.
double mean_wait_s(const roads::Signal& signal, std::size_t link) {
    double cycle_s = 0.0, waited_s2 = 0.0, red_s = 0.0, first_red_s = -1.0;
    const auto end_red = [&] {
        if (first_red_s < 0.0)
            first_red_s = red_s;  // it may go on from the end of the cycle
        else
            waited_s2 += red_s * red_s / 2.0;
        red_s = 0.0;
    };
    for (const roads::Phase& phase : signal.program) {
        const double lasting_s = phase.duration_s + phase.yellow_s + phase.red_s;
        cycle_s += lasting_s;
        if (link < phase.state.size() && is_green(phase.state[link]))
            end_red();
        else
            red_s += lasting_s;
    }
    if (first_red_s < 0.0 || cycle_s <= 0.0) return 0.0;  // never green: not a link to wait for
    red_s += first_red_s;
    return (waited_s2 + red_s * red_s / 2.0) / cycle_s;
}

}  // namespace

EdgeTimes::EdgeTimes(const roads::Network& network, const roads::RouteSearch& search,
                     const EdgeTimesConfig& config)
    : network_(network), search_(search), config_(config), seen_(network.edges().size()) {
    for (std::uint32_t row = 0; row < network.edges().size(); ++row) {
        length_m_.push_back(network.edge(core::EdgeIndex{row}).length_m);
        const double wait_s = mean_wait_s(core::EdgeIndex{row});
        signal_.push_back(wait_s >= 0.0);
        const double mean_s = config.mean_times_s.empty() ? 0.0 : config.mean_times_s[row];
        usual_delay_s_.push_back(
            std::max(0.0, mean_s > 0.0 ? mean_s - search.free_s(core::EdgeIndex{row}) : wait_s));
    }
    config_.mean_times_s = {};
}

/// Mean over the links of the edge; negative without a signal.
double EdgeTimes::mean_wait_s(core::EdgeIndex index) const {
    const roads::Edge& edge = network_.edge(index);
    double sum_s = 0.0;
    int links = 0;
    for (std::uint32_t lane = edge.first_lane; lane < edge.first_lane + edge.lane_count; ++lane) {
        for (const roads::Connection& way : network_.connections_from(core::LaneIndex{lane})) {
            if (edge.internal || !way.signal.exists() || !way.allows_emergency) continue;
            sum_s += policy::mean_wait_s(network_.signal(way.signal), way.signal_link);
            ++links;
        }
    }
    return links == 0 ? -1.0 : sum_s / links;
}

double EdgeTimes::fading(double lasting_s) const {
    return std::exp(-lasting_s / config_.fade_s);
}

void EdgeTimes::see(const traffic::BelievedGraph& belief, core::Seconds period) {
    turn_to(belief.time);
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
        if (vehicle.vehicle_class != traffic::VehicleClass::emergency)
            add(vehicle.state.lane, vehicle.state.speed_mps, period);
    }
}

void EdgeTimes::add(core::LaneIndex lane, float speed_mps, core::Seconds period) {
    if (!lane.exists()) return;
    const core::EdgeIndex edge = network_.lane(lane).edge;
    if (network_.edge(edge).internal) return;
    Seen& seen = seen_[edge.value];
    const double share = fading(now_s_ - seen.at_s);
    seen.time_s = seen.time_s * share + period.value;
    seen.distance_m = seen.distance_m * share + speed_mps * period.value;
    seen.at_s = now_s_;
}

/// From now until a signal that is asked now is green and the vehicles before it have left. `vehicle_s`: the
/// time of vehicles on the edge that is remembered; each adds its share of the memory.
double EdgeTimes::ready_s(core::EdgeIndex edge, double vehicle_s) const {
    const double in_a_lane = vehicle_s / config_.fade_s / network_.edge(edge).lane_count;
    return transition_s + headway_s * in_a_lane;
}

double EdgeTimes::at(core::EdgeIndex edge, double entered_s, double pace) const {
    const double limit_s = search_.free_s(edge);
    if (limit_s == roads::no_way_s) return limit_s;
    const double length_m = std::max(length_m_[edge.value], 0.1);
    const double prior_s = limit_s + usual_delay_s_[edge.value];
    const Seen& seen = seen_[edge.value];
    const double share = seen.time_s > 0.0 ? fading(now_s_ - seen.at_s) : 0.0;
    const double speed_mps = (seen.distance_m * share + config_.prior_s * length_m / prior_s) /
                             (seen.time_s * share + config_.prior_s);
    const double seen_delay_s = std::max(0.0, length_m / std::max(speed_mps, least_mps) - limit_s);
    const double prior_delay_s = prior_s - limit_s;
    const double difference_s = seen_delay_s - prior_delay_s;
    double delay_s = prior_delay_s + difference_s * fading(entered_s);
    // Nobody leaves a queue before those who entered it earlier, however fast its memory fades.
    double excess_s = 0.0;
    if (difference_s > 0.0) {
        excess_s = std::max(difference_s * fading(entered_s), difference_s - entered_s);
        delay_s = std::max(delay_s, prior_delay_s + difference_s - entered_s);
    }
    const double drive_s = limit_s / pace;
    if (!signal_[edge.value]) return drive_s + delay_s;
    delay_s *= config_.signal_share;
    if (config_.are_asked) {
        const double late_s = ready_s(edge, seen.time_s * share) - (entered_s + drive_s);
        delay_s = std::min(delay_s, std::max({0.0, late_s, excess_s}));
    }
    return drive_s + delay_s;
}

}  // namespace clearway::policy
