#include "report/map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

namespace clearway::report {
namespace {

double length_within(const RoadMap& map, const std::vector<ReachedEdge>& edges,
                     std::optional<double> ReachedEdge::*time, double within_s) {
    double sum_m = 0.0;
    for (std::size_t edge = 0; edge < edges.size(); ++edge) {
        const std::optional<double>& at_s = edges[edge].*time;
        if (at_s && *at_s <= within_s) sum_m += map.edges[edge].length_m;
    }
    return sum_m;
}

/// How much longer emergency vehicles of the baseline needed on the edges that they drove than at the limit.
double delay_of(const RoadMap& map, const std::vector<EdgeTimes>& times) {
    double needed_s = 0.0;
    double at_limit_s = 0.0;
    for (const EdgeTimes& time : times) {
        const auto passages = static_cast<double>(time.passages);
        needed_s += passages * time.baseline_s;
        at_limit_s += passages * map.edges[time.edge].free_flow_s();
    }
    return at_limit_s > 0.0 ? needed_s / at_limit_s : 1.0;
}

std::vector<double> edge_seconds(const RoadMap& map, const std::vector<EdgeTimes>& times,
                                 double EdgeTimes::*seconds, double delay) {
    std::vector<double> all;
    for (const MapEdge& edge : map.edges)
        all.push_back(delay * edge.free_flow_s());
    for (const EdgeTimes& time : times)
        all[time.edge] = time.*seconds;
    return all;
}

}  // namespace

std::optional<std::size_t> RoadMap::find_edge(const std::string& id) const {
    const auto found = std::ranges::find(edges, id, &MapEdge::id);
    if (found == edges.end()) return std::nullopt;
    return static_cast<std::size_t>(found - edges.begin());
}

double Reach::baseline_m(const RoadMap& map, double within_s) const {
    return length_within(map, edges, &ReachedEdge::baseline_s, within_s);
}

double Reach::condition_m(const RoadMap& map, double within_s) const {
    return length_within(map, edges, &ReachedEdge::condition_s, within_s);
}

std::vector<std::optional<double>> times_from(const RoadMap& map, const std::vector<std::size_t>& starts,
                                              const std::vector<double>& edge_s) {
    std::vector<std::optional<double>> reached(map.edges.size());
    using Entry = std::pair<double, std::size_t>;  // time at the end of an edge
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (const std::size_t start : starts)
        open.emplace(edge_s[start], start);
    while (!open.empty()) {
        const auto [time_s, edge] = open.top();
        open.pop();
        if (reached[edge]) continue;
        reached[edge] = time_s;
        for (const std::size_t next : map.edges[edge].to) {
            if (!reached[next]) open.emplace(time_s + edge_s[next], next);
        }
    }
    return reached;
}

std::optional<Reach> reach_of(const RoadMap& map, const std::vector<EdgeTimes>& times,
                              std::vector<std::size_t> starts, double usual_trip_s) {
    if (times.empty() || starts.empty()) return std::nullopt;
    Reach reach;
    reach.starts = std::move(starts);
    reach.minutes = std::max(1.0, std::round(usual_trip_s / 2.0 / 60.0));
    reach.delay = delay_of(map, times);
    const auto before =
        times_from(map, reach.starts, edge_seconds(map, times, &EdgeTimes::baseline_s, reach.delay));
    const auto after =
        times_from(map, reach.starts, edge_seconds(map, times, &EdgeTimes::condition_s, reach.delay));
    for (std::size_t edge = 0; edge < map.edges.size(); ++edge)
        reach.edges.push_back({before[edge], after[edge], false});
    for (const EdgeTimes& time : times)
        reach.edges[time.edge].driven = true;
    return reach;
}

}  // namespace clearway::report
