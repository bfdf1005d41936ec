#include "metrics/detail/traffic_watch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/match_rows.hpp"
#include "metrics/detail/standing.hpp"

namespace clearway::metrics::detail {
namespace {

using traffic::VehicleClass;

constexpr double sample_period_s = 5.0;
constexpr double first_offset_s = -60.0;
constexpr double last_offset_s = 240.0;
constexpr double place_period_s = 1.0;
constexpr double place_tolerance_m = 2.0;  // half a car: invisible in a figure of a few km

std::size_t column_of(VehicleClass vehicle_class) {
    return vehicle_class == VehicleClass::automated ? 1 : 0;
}

/// What the links of a path show: the most permissive of them.
char shown_by(const std::string& state, const std::vector<std::uint16_t>& links) {
    char best = 'r';
    for (const std::uint16_t link : links) {
        if (link >= state.size()) continue;
        if (traffic::is_green(state[link])) return 'g';
        if (state[link] == 'y' || state[link] == 'Y') best = 'y';
    }
    return best;
}

std::string_view name_of(char shown) {
    return shown == 'g' ? "green" : shown == 'y' ? "yellow" : "red";
}

/// Whether two ways pass the same stop line at the same distance.
bool is_same(const RouteSignal& one, const RouteSignal& other) {
    constexpr double tolerance_m = 1.0;  // lanes of an edge end that near each other
    return one.signal == other.signal && one.approach == other.approach &&
           std::abs(one.distance_m - other.distance_m) < tolerance_m;
}

/// Whether every place between the two lies within the tolerance of the line that joins them.
template <class Place>
bool is_straight(const std::vector<Place>& places, std::size_t from, std::size_t to) {
    const double speed =
        (places[to].distance_m - places[from].distance_m) / (places[to].time_s - places[from].time_s);
    for (std::size_t at = from + 1; at < to; ++at) {
        const double expected = places[from].distance_m + speed * (places[at].time_s - places[from].time_s);
        if (std::abs(places[at].distance_m - expected) > place_tolerance_m) return false;
    }
    return true;
}

/// A few of the places, chosen greedily, such that the straight lines between them stay within the tolerance
/// of all places.
template <class Place>
std::vector<Place> simplified(const std::vector<Place>& places) {
    std::vector<Place> kept;
    std::size_t from = 0;
    for (std::size_t to = 1; to <= places.size(); ++to) {
        if (to < places.size() && is_straight(places, from, to)) continue;
        if (kept.empty()) kept.push_back(places[from]);
        if (to - 1 == from) continue;
        kept.push_back(places[to - 1]);
        from = to - 1;
        if (to < places.size()) --to;
    }
    return kept;
}

}  // namespace

TrafficWatch::TrafficWatch(const RoadLayout& layout)
    : layout_(layout),
      routes_(layout.routes),
      losses_(layout_.approaches.size()),
      halted_(layout_.approaches.size()),
      journeys_(layout_.routes.size()) {}

void TrafficWatch::step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                        const std::vector<std::uint32_t>& before) {
    const double now_s = snapshot.time.value;
    assert(before.size() == snapshot.size() && now_s >= last_s_);
    const double elapsed_s = last_s_ < 0.0 ? 0.0 : now_s - last_s_;
    if (last_s_ < 0.0) first_s_ = now_s;
    last_s_ = now_s;
    count_vehicles(snapshot, before, elapsed_s);
    sample_halted(now_s);
    follow(snapshot, roster);
}

void TrafficWatch::count_vehicles(const truth::Snapshot& snapshot, const std::vector<std::uint32_t>& before,
                                  double elapsed_s) {
    std::ranges::fill(halted_, 0U);
    approach_.resize(snapshot.size());
    for (std::size_t row = 0; row < snapshot.size(); ++row) {
        const std::uint32_t lane = snapshot.lane[row].value;
        const bool on_lane = lane < layout_.approach_of_lane.size();
        const std::int32_t approach = on_lane ? layout_.approach_of_lane[lane] : RoadLayout::no_approach;
        approach_[row] = approach;
        if (approach == RoadLayout::no_approach || snapshot.vehicle_class[row] == VehicleClass::emergency)
            continue;
        const auto place = static_cast<std::size_t>(approach);
        Loss& loss = losses_[place][column_of(snapshot.vehicle_class[row])];
        if (before[row] == core::no_row || previous_approach_[before[row]] != approach) {
            ++loss.vehicles;
            // Vehicles that are already there when the watch begins did not enter during it.
            if (snapshot.time.value > first_s_ && snapshot.time.value <= layout_.demand_until_s)
                ++loss.of_demand;
        }
        const float speed_mps = snapshot.speed_mps[row];
        if (speed_mps < standing_mps) {
            loss.waiting_time_s += elapsed_s;
            ++halted_[place];
        }
        const float limit_mps = layout_.limit_of_lane_mps[lane];
        if (speed_mps < limit_mps)
            loss.time_loss_s += elapsed_s * (1.0 - static_cast<double>(speed_mps / limit_mps));
    }
    previous_approach_.swap(approach_);
}

void TrafficWatch::sample_halted(double time_s) {
    if (samples_.empty()) first_sample_s_ = time_s;
    const double due_s = first_sample_s_ + static_cast<double>(samples_.size()) * sample_period_s;
    if (time_s + core::clock_tolerance_s >= due_s) samples_.push_back(halted_);
}

void TrafficWatch::follow(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    for (std::size_t number = 0; number < routes_.size(); ++number) {
        WatchedRoute& route = routes_[number];
        const auto row = snapshot.row_of(route.vehicle);
        if (!row) continue;
        follow_way(roster, route, journeys_[number]);
        follow(snapshot, *row, route, journeys_[number]);
    }
}

void TrafficWatch::follow_way(const traffic::Roster& roster, WatchedRoute& route, Journey& journey) const {
    const traffic::VehicleInfo* const vehicle = roster.find(route.vehicle);
    if (vehicle == nullptr || !layout_.on_way || vehicle->route == journey.way) return;
    journey.way = vehicle->route;
    const std::vector<core::EdgeIndex>& edges = roster.route(vehicle->route);
    const auto id_of = [&](core::EdgeIndex edge) -> const std::string& {
        return layout_.chain.edge_ids[edge.value];
    };
    if (std::ranges::equal(route.edges, edges, {}, {}, id_of)) return;
    WatchedRoute taken = layout_.on_way(layout_, route, edges);
    // Signals ahead on the former way are of no interest any more.
    std::vector<SignalChange> changes;
    std::vector<char> shown(taken.signals.size(), '-');
    for (SignalChange& change : journey.changes) {
        const auto same = std::ranges::find_if(taken.signals, [&](const RouteSignal& one) {
            return is_same(one, route.signals[change.signal]);
        });
        if (same == taken.signals.end()) continue;
        change.signal = static_cast<std::uint32_t>(same - taken.signals.begin());
        shown[change.signal] = change.shown;
        changes.push_back(change);
    }
    journey.changes = std::move(changes);
    journey.shown = std::move(shown);
    journey.entered_s.resize(taken.edges.size(), -1.0);
    route = std::move(taken);
}

void TrafficWatch::follow(const truth::Snapshot& snapshot, std::size_t row, const WatchedRoute& route,
                          Journey& journey) {
    const double now_s = snapshot.time.value;
    const std::uint32_t edge = snapshot.route_edge[row];
    const std::uint32_t lane = snapshot.lane[row].value;
    if (edge >= route.edge_start_m.size() || lane >= layout_.internal_lane.size()) return;
    const bool inside = layout_.internal_lane[lane] != 0;
    pass(now_s, edge, inside, route, journey);
    journey.entered_s.resize(route.edge_start_m.size(), -1.0);
    if (journey.entered_s[edge] < 0.0) journey.entered_s[edge] = now_s;
    journey.last_s = now_s;
    if (!layout_.keep_journeys) return;
    double distance_m = route.edge_start_m[edge] + static_cast<double>(snapshot.lane_position_m[row]);
    if (inside) distance_m += route.edge_length_m[edge];
    if (!journey.places.empty()) distance_m = std::max(distance_m, journey.places.back().distance_m);
    if (journey.places.empty() ||
        now_s + core::clock_tolerance_s >= journey.places.back().time_s + place_period_s)
        journey.places.push_back({now_s, distance_m});
    journey.shown.resize(route.signals.size(), '-');
    for (std::uint32_t number = 0; number < route.signals.size(); ++number) {
        const RouteSignal& signal = route.signals[number];
        const char shown = shown_by(snapshot.signals.state[signal.signal.value], signal.links);
        if (shown == journey.shown[number]) continue;
        journey.shown[number] = shown;
        journey.changes.push_back({now_s, number, shown});
    }
}

void TrafficWatch::pass(double now_s, std::uint32_t edge, bool inside, const WatchedRoute& route,
                        Journey& journey) {
    const bool left = inside || edge != journey.route_edge;
    if (journey.seen && left && !journey.passed && journey.route_edge < route.approach.size()) {
        const std::int32_t approach = route.approach[journey.route_edge];
        if (approach != RoadLayout::no_approach) passages_.push_back({now_s, approach});
        journey.passed = true;
    }
    if (!journey.seen || edge != journey.route_edge) journey.passed = inside;
    journey.seen = true;
    journey.route_edge = edge;
}

double TrafficWatch::others_halted(const Passage& passage, std::size_t sample) const {
    const core::SignalIndex signal = layout_.approaches[static_cast<std::size_t>(passage.approach)].signal;
    assert(signal.exists() && sample < samples_.size());
    std::uint64_t halted = 0;
    for (std::size_t approach = 0; approach < layout_.approaches.size(); ++approach) {
        if (layout_.approaches[approach].signal == signal &&
            static_cast<std::int32_t>(approach) != passage.approach)
            halted += samples_[sample][approach];
    }
    return static_cast<double>(halted);
}

std::vector<RecoveryRow> TrafficWatch::recovery() const {
    std::vector<RecoveryRow> rows;
    for (double offset_s = first_offset_s; offset_s <= last_offset_s; offset_s += sample_period_s) {
        RecoveryRow row{offset_s, 0, 0.0};
        for (const Passage& passage : passages_) {
            if (!layout_.approaches[static_cast<std::size_t>(passage.approach)].signal.exists()) continue;
            const double at =
                std::floor((passage.time_s + offset_s - first_sample_s_) / sample_period_s + 1e-9);
            if (at < 0.0 || at >= static_cast<double>(samples_.size())) continue;
            ++row.passages;
            row.halted_vehicles += others_halted(passage, static_cast<std::size_t>(at));
        }
        if (row.passages == 0) continue;
        row.halted_vehicles /= static_cast<double>(row.passages);
        rows.push_back(row);
    }
    return rows;
}

std::vector<JourneyRow> TrafficWatch::journeys() const {
    std::vector<JourneyRow> rows;
    for (std::size_t number = 0; number < journeys_.size(); ++number) {
        const WatchedRoute& route = routes_[number];
        for (const Place& place : simplified(journeys_[number].places))
            rows.push_back({route.id, "", "", place.time_s, place.distance_m});
        for (const SignalChange& change : journeys_[number].changes) {
            const RouteSignal& signal = route.signals[change.signal];
            rows.push_back(
                {route.id, signal.id, std::string(name_of(change.shown)), change.time_s, signal.distance_m});
        }
    }
    return rows;
}

std::vector<EdgeTimeRow> TrafficWatch::edge_times() const {
    std::vector<EdgeTimeRow> rows;
    for (std::size_t number = 0; number < journeys_.size(); ++number) {
        const WatchedRoute& route = routes_[number];
        const Journey& journey = journeys_[number];
        for (std::size_t edge = 0; edge < std::min(journey.entered_s.size(), route.edges.size()); ++edge) {
            const double entered_s = journey.entered_s[edge];
            const bool last = edge + 1 == journey.entered_s.size();
            const double left_s = last ? journey.last_s : journey.entered_s[edge + 1];
            if (entered_s >= 0.0 && left_s >= entered_s)
                rows.push_back({route.id, route.edges[edge], entered_s, left_s - entered_s});
        }
    }
    return rows;
}

TrafficTables TrafficWatch::tables() const {
    TrafficTables tables;
    const double hours = (std::min(last_s_, layout_.demand_until_s) - first_s_) / 3600.0;
    for (std::size_t approach = 0; approach < losses_.size(); ++approach) {
        for (const VehicleClass vehicle_class : {VehicleClass::human, VehicleClass::automated}) {
            const Loss& loss = losses_[approach][column_of(vehicle_class)];
            if (loss.vehicles == 0) continue;
            tables.approaches.push_back({layout_.approaches[approach].edge, vehicle_class, loss.vehicles,
                                         loss.waiting_time_s, loss.time_loss_s,
                                         hours > 0.0 ? static_cast<double>(loss.of_demand) / hours : 0.0});
        }
    }
    tables.recovery = recovery();
    tables.journeys = journeys();
    tables.edge_times = edge_times();
    return tables;
}

}  // namespace clearway::metrics::detail
