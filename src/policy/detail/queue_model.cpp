#include "policy/detail/queue_model.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "roads/link_green.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy::detail {
namespace {

/// Between two vehicles that a green serves, s; where they must yield, as a turn through gaps.
constexpr double headway_s = 2.0;
constexpr double yielding_headway_s = 3.5;
/// From the start of green until the first of a queue passes, s.
constexpr double start_up_s = 2.0;
/// A vehicle that comes to a green is not slowed down if its way was free for so long, s; otherwise it loses
/// half of what is missing.
constexpr double free_before_s = 4.0;
/// A hold ends so long after the emergency vehicle has passed, s, or at its cap: by default that of
/// actuation, which a policy does not know.
constexpr double after_s = 1.5;
constexpr double cap_s = 60.0;
constexpr double acceleration_mps2 = 2.0;
constexpr double crawling_mps = 1.0;

/// Until a vehicle has driven so far along its route on a free road, s. It accelerates to the allowed speed.
double travel_s(const View& view, const traffic::BelievedVehicle& vehicle, double distance_m) {
    const double allowed_mps = std::max(view.allowed_speed(vehicle).value, crawling_mps);
    const double lack_mps = std::max(0.0, allowed_mps - vehicle.state.speed_mps);
    const double lost_m = std::min(distance_m / 2.0, lack_mps * lack_mps / (2.0 * acceleration_mps2));
    return free_travel_time_s(view, vehicle, distance_m) + lost_m / allowed_mps;
}

}  // namespace

std::optional<core::EdgeIndex> edge_before(const View& view, const Arrival& arrival) {
    const roads::Signal& signal = view.network().signal(arrival.approach.signal);
    const auto ends_here = [&](core::EdgeIndex edge) {
        return std::ranges::any_of(arrival.approach.own_links, [&](std::uint16_t link) {
            return std::ranges::any_of(signal.links[link], [&](const roads::SignalLink& way) {
                return view.network().lane(way.from).edge == edge;
            });
        });
    };
    const roads::Route route = view.route_of(arrival.emergency.key);
    const auto first = std::min<std::size_t>(arrival.emergency.state.route_edge, route.size());
    const auto found =
        std::find_if(route.begin() + static_cast<std::ptrdiff_t>(first), route.end(), ends_here);
    return found == route.end() ? std::nullopt : std::optional(*found);
}

double free_s_to(const View& view, const Arrival& arrival) {
    const double whole_s = travel_s(view, arrival.emergency, arrival.approach.distance_m);
    return std::max(0.0, whole_s - travel_s(view, arrival.emergency, arrival.moved_m));
}

QueueModel::QueueModel(const View& view, const Arrival& arrival, const SignalForecaster& forecaster,
                       const Premises& premises, Workspace& workspace)
    : network_(view.network()),
      signal_(view.network().signal(arrival.approach.signal)),
      forecaster_(forecaster),
      emergency_worth_(premises.emergency_worth),
      pace_(premises.pace),
      own_edge_(premises.edge),
      workspace_(workspace) {
    assert(!arrival.approach.own_links.empty());
    workspace_.greens_.resize(std::max(workspace_.greens_.size(), signal_.links.size()));
    workspace_.forecast_.held.clear();
    workspace_.edges_.clear();
    workspace_.green_share_.clear();
    for (std::size_t link = 0; link < signal_.links.size(); ++link) {
        workspace_.green_share_.push_back(roads::link_green(signal_, link).share);
        for (const roads::SignalLink& way : signal_.links[link])
            if (queue_of(way.from) == nullptr) add_queue(way.from);
    }
    const double free_s = free_s_to(view, arrival) / pace_;
    arrival_s_ = std::max(premises.not_before_s, std::min(free_s, arrival.announced_s.value_or(free_s)));
    delay_s_ = std::max(0.0, premises.not_before_s - free_s);
    const bool sees = premises.sight == ModelSight::all;
    if (sees) {
        add_near(view, arrival);
        add_ahead(view, arrival);
    }
    for (Queue& queue : queues_)
        std::ranges::sort(queue.vehicles, {}, &Vehicle::distance_m);
    add_own(arrival, std::max(0.0, arrival.approach.distance_m - arrival.moved_m));
    if (sees) std::ranges::for_each(queues_, [&](Queue& queue) { add_expected(queue); });
}

void QueueModel::add_queue(core::LaneIndex lane) {
    const std::size_t row = queues_.size();
    if (row == workspace_.queues_.size()) workspace_.queues_.emplace_back();
    queues_ = std::span(workspace_.queues_).first(row + 1);
    queues_[row].lane = lane;
    queues_[row].vehicles.clear();
    const core::EdgeIndex edge = network_.lane(lane).edge;
    if (!is_near(edge)) workspace_.edges_.push_back(edge);
}

/// Whether an edge ends at the signal.
bool QueueModel::is_near(core::EdgeIndex edge) const {
    return core::contains(workspace_.edges_, edge);
}

QueueModel::Queue* QueueModel::queue_of(core::LaneIndex lane) {
    const auto found = std::ranges::find(queues_, lane, &Queue::lane);
    return found == queues_.end() ? nullptr : &*found;
}

double QueueModel::weight_of(const traffic::BelievedVehicle& vehicle) const {
    return vehicle.vehicle_class == traffic::VehicleClass::emergency ? emergency_worth_ : 1.0;
}

/// Into the nearest queue of its edge from which it can go where it wants. Who may turn on red waits for
/// nobody here.
void QueueModel::place(const traffic::BelievedVehicle& vehicle, double earliest_s,
                       std::optional<core::EdgeIndex> next) {
    const roads::Lane& here = network_.lane(vehicle.state.lane);
    constexpr int elsewhere = 1000;  // more than an edge has lanes
    int least = 2 * elsewhere;
    Vehicle placed{earliest_s, std::max(0.0F, here.length_m - vehicle.state.lane_position_m), 0,
                   weight_of(vehicle)};
    Queue* chosen = nullptr;
    const auto link_count = static_cast<std::uint16_t>(signal_.links.size());
    for (std::uint16_t link = 0; link < link_count; ++link) {
        if (workspace_.green_share_[link] <= 0.0) continue;
        for (const roads::SignalLink& way : signal_.links[link]) {
            const roads::Lane& from = network_.lane(way.from);
            if (from.edge != here.edge) continue;
            const int away = std::abs(static_cast<int>(from.number) - static_cast<int>(here.number)) +
                             (network_.lane(way.to).edge == next ? 0 : elsewhere);
            if (away >= least) continue;
            least = away;
            placed.link = link;
            chosen = queue_of(way.from);
        }
    }
    if (chosen != nullptr) chosen->vehicles.push_back(placed);
}

/// Who is on an edge that ends at the signal.
void QueueModel::add_near(const View& view, const Arrival& arrival) {
    const auto add = [&](const traffic::BelievedVehicle& vehicle) {
        if (vehicle.key == arrival.emergency.key || !vehicle.state.lane.exists()) return;
        const roads::Lane& lane = network_.lane(vehicle.state.lane);
        if (!is_near(lane.edge)) return;
        const roads::Route route = view.route_of(vehicle.key);
        const std::size_t after = vehicle.state.route_edge + 1;
        const auto next = after < route.size() ? std::optional(route[after]) : std::nullopt;
        const double left_m = std::max(0.0F, lane.length_m - vehicle.state.lane_position_m);
        place(vehicle, travel_s(view, vehicle, left_m), next);
    };
    for (const traffic::BelievedVehicle& vehicle : view.belief().vehicles)
        if (vehicle.vehicle_class != traffic::VehicleClass::emergency) add(vehicle);
    for (const traffic::BelievedVehicle& vehicle : view.emergency_vehicles())
        add(vehicle);
}

/// Who is ahead of the emergency vehicle on earlier edges and comes to the same stop line, on the lane with
/// the nearest number. What holds the emergency vehicle up holds it up, too.
void QueueModel::add_ahead(const View& view, const Arrival& arrival) {
    std::vector<std::pair<core::LaneIndex, std::uint16_t>> ways;
    for (const std::uint16_t link : arrival.approach.own_links)
        for (const roads::SignalLink& way : signal_.links[link])
            if (network_.lane(way.from).edge == own_edge_) ways.emplace_back(way.from, link);
    const auto comes_here = [&](const traffic::BelievedVehicle& vehicle) {
        const roads::Route route = view.route_of(vehicle.key);
        const auto onward = route.subspan(std::min<std::size_t>(vehicle.state.route_edge, route.size()));
        return std::ranges::find(onward, own_edge_) != onward.end();
    };
    for (const VehicleAhead& ahead :
         view.vehicles_ahead(arrival.emergency, core::Metres(arrival.approach.distance_m))) {
        const traffic::BelievedVehicle& vehicle = *ahead.vehicle;
        const roads::Lane& lane = network_.lane(vehicle.state.lane);
        if (ahead.distance_m < arrival.moved_m || is_near(lane.edge) || !comes_here(vehicle)) continue;
        const double left_m = arrival.approach.distance_m - ahead.distance_m;
        const double free_s = travel_s(view, vehicle, left_m) / pace_;
        const double earliest_s = std::max(free_s, std::min(free_s + delay_s_, arrival_s_ - headway_s));
        const auto away = [&](const std::pair<core::LaneIndex, std::uint16_t>& way) {
            return std::abs(static_cast<int>(network_.lane(way.first).number) -
                            static_cast<int>(lane.number));
        };
        const auto& [to, link] = *std::ranges::min_element(ways, {}, away);
        queue_of(to)->vehicles.push_back({earliest_s, left_m, link, weight_of(vehicle)});
    }
}

/// Into the shortest queue from which it can go on, its own lane's among equals.
void QueueModel::add_own(const Arrival& arrival, double left_m) {
    std::size_t least = SIZE_MAX;
    std::uint16_t link = 0;
    const auto is_before = [&](const Vehicle& other) { return other.distance_m < left_m; };
    for (const std::uint16_t number : arrival.approach.own_links) {
        for (const roads::SignalLink& way : signal_.links[number]) {
            if (network_.lane(way.from).edge != own_edge_) continue;
            const Queue& queue = *queue_of(way.from);
            const bool is_here = arrival.moved_m <= 0.0 && way.from == arrival.emergency.state.lane;
            const auto before = static_cast<std::size_t>(std::ranges::count_if(queue.vehicles, is_before));
            if (const std::size_t cost = 2 * before + (is_here ? 0 : 1); cost < least) {
                least = cost;
                link = number;
                own_queue_ = static_cast<std::size_t>(&queue - queues_.data());
            }
        }
    }
    auto& vehicles = queues_[own_queue_].vehicles;
    vehicles.insert(std::ranges::partition_point(vehicles, is_before), {arrival_s_, left_m, link, 0.0, true});
}

/// Those who will come, as densely as those who are there, but no more than the program lets pass. Who is
/// ahead of the emergency vehicle on its own way is known.
void QueueModel::add_expected(Queue& queue) const {
    const roads::Lane& lane = network_.lane(queue.lane);
    const double cycle_s = forecaster_.cycle_s();
    const auto near_end = std::ranges::partition_point(
        queue.vehicles, [&](const Vehicle& vehicle) { return vehicle.distance_m <= lane.length_m; });
    if (near_end == queue.vehicles.begin() || cycle_s <= 0.0) return;
    const auto here = static_cast<double>(std::count_if(
        queue.vehicles.begin(), near_end, [](const Vehicle& vehicle) { return !vehicle.is_own; }));
    const std::uint16_t link = std::prev(near_end)->link;
    const double green_s = workspace_.green_share_[link] * cycle_s;
    const double through_s = lane.length_m / std::max<double>(lane.speed_limit_mps, crawling_mps);
    const double stay_s = through_s + (cycle_s - green_s) / 2.0;
    const double flow_per_s = std::min(here / stay_s, green_s / cycle_s / headway_s);
    if (flow_per_s <= 0.0) return;
    const double from_s = lane.edge == own_edge_ ? std::max(through_s, arrival_s_) : through_s;
    for (double at_s = from_s + 0.5 / flow_per_s; at_s < horizon_s; at_s += 1.0 / flow_per_s)
        queue.vehicles.push_back({at_s, lane.length_m + at_s * lane.speed_limit_mps, link, 1.0});
}

/// Of the present forecast.
const std::vector<QueueModel::Green>& QueueModel::greens_of(std::uint16_t link) const {
    Greens& greens = workspace_.greens_[link];
    if (greens.forecast == workspace_.forecasts_) return greens.pieces;
    greens.forecast = workspace_.forecasts_;
    greens.pieces.clear();
    std::optional<double> since_s;
    for (const ShownPiece& piece : workspace_.forecast_.pieces) {
        const char letter = link < piece.state.size() ? piece.state[link] : 'r';
        if (!traffic::is_green(letter)) {
            since_s.reset();
            continue;
        }
        if (!since_s)
            since_s = &piece == &workspace_.forecast_.pieces.front() ? -free_before_s : piece.from_s;
        greens.pieces.push_back({piece.to_s, *since_s, letter});
    }
    return greens.pieces;
}

double QueueModel::drain(const Queue& queue, double& waited_s) const {
    double own_s = horizon_s;
    double free_s = -free_before_s;  // since when the stop line is free
    const std::vector<Green>* greens = nullptr;
    std::uint16_t link = 0;
    std::size_t next = 0;
    for (const Vehicle& vehicle : queue.vehicles) {
        if (greens == nullptr || link != vehicle.link) {
            link = vehicle.link;
            greens = &greens_of(link);
            next = 0;
        }
        const double ready_s = std::max({0.0, vehicle.earliest_s, free_s});
        while (next < greens->size() && (*greens)[next].to_s <= ready_s)
            ++next;
        const Green* const green = next < greens->size() ? &(*greens)[next] : nullptr;
        double passes_s = horizon_s;
        if (green != nullptr)
            passes_s = std::min(horizon_s, green->since_s > ready_s ? green->since_s + start_up_s : ready_s);
        if (vehicle.is_own) {
            const double free_for_s =
                vehicle.earliest_s - std::max(free_s, green != nullptr ? green->since_s : horizon_s);
            if (free_for_s >= 0.0) passes_s += std::max(0.0, free_before_s - free_for_s) / 2.0;
            own_s = passes_s;
        } else {
            waited_s += vehicle.weight * std::max(0.0, passes_s - vehicle.earliest_s);
        }
        free_s = passes_s + (green != nullptr && green->letter == 'g' ? yielding_headway_s : headway_s);
    }
    return own_s;
}

std::optional<QueueModel::Outcome> QueueModel::outcome(std::optional<double> start_s, double latest_s) const {
    SignalForecast& forecast = workspace_.forecast_;
    ++workspace_.forecasts_;
    double ignored_s = 0.0;
    if (start_s) {
        forecaster_.hold(*start_s, horizon_s, forecast);
    } else {
        forecaster_.program(horizon_s, forecast);
    }
    // The end of the hold makes it no faster.
    const double passes_s = drain(queues_[own_queue_], ignored_s);
    if (passes_s > latest_s) return std::nullopt;
    if (start_s) {
        forecaster_.release(forecast, std::min(passes_s + after_s, *start_s + cap_s), horizon_s);
        ++workspace_.forecasts_;
    }
    Outcome outcome;
    for (const Queue& queue : queues_) {
        const double own_s = drain(queue, outcome.waited_s);
        if (&queue == &queues_[own_queue_]) outcome.passing_s = own_s;
    }
    return outcome;
}

}  // namespace clearway::policy::detail
