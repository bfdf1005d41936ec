#include <algorithm>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/map_canvas.hpp"

namespace clearway::report::detail {
namespace {

constexpr double least_margin_m = 60.0;
constexpr double margin_share = 0.06;   // of the longer side
constexpr double narrowest_part = 0.5;  // of the longer side, so that the map is not stretched
constexpr double metres_per_km = 1000.0;

/// The trip of the time-space figure if it has two ways; else of those that ended alike the one whose gain is
/// the median.
const ChangedWay* shown_change(const ScenarioFacts& scenario) {
    std::vector<const ChangedWay*> whole;
    for (const ChangedWay& change : scenario.map->changed_ways) {
        if (change.baseline.back() != change.condition.back()) continue;
        if (is_shown_trip(scenario, change)) return &change;
        whole.push_back(&change);
    }
    if (whole.empty()) return nullptr;
    std::ranges::stable_sort(whole, {}, &ChangedWay::gain_s);
    return whole[(whole.size() - 1) / 2];
}

/// The roads around two ways; the ways are the first two of its rows.
struct Surroundings {
    RoadMap roads;
    std::vector<MapPlace> before, after;  ///< The ways as lines.

    Surroundings(const RoadMap& all, const ChangedWay& change)
        : before(line_of(all, change.baseline)), after(line_of(all, change.condition)) {
        add_box();
        for (const MapEdge& edge : all.edges) {
            const bool is_near = std::ranges::all_of(edge.shape, [&](const MapPlace& at) {
                return at.first >= left_ && at.first <= right_ && at.second >= low_ && at.second <= high_;
            });
            if (is_near && !edge.shape.empty()) roads.edges.push_back(edge);
        }
        add_edges(all, change.baseline);
        add_edges(all, change.condition);
        for (const MapIncident& incident : all.incidents) {
            if (roads.find_edge(incident.edge)) roads.incidents.push_back(incident);
        }
    }

  private:
    static std::vector<MapPlace> line_of(const RoadMap& all, const std::vector<std::size_t>& edges) {
        std::vector<MapPlace> line;
        for (const std::size_t edge : edges)
            line.insert(line.end(), all.edges[edge].shape.begin(), all.edges[edge].shape.end());
        return line;
    }
    /// Those that reach beyond the box.
    void add_edges(const RoadMap& all, const std::vector<std::size_t>& edges) {
        for (const std::size_t edge : edges) {
            if (!roads.find_edge(all.edges[edge].id)) roads.edges.push_back(all.edges[edge]);
        }
    }
    void add_box() {
        for (const auto* const line : {&before, &after}) {
            for (const auto& [x, y] : *line) {
                left_ = std::min(left_, x);
                right_ = std::max(right_, x);
                low_ = std::min(low_, y);
                high_ = std::max(high_, y);
            }
        }
        const double longer_m = std::max(right_ - left_, high_ - low_);
        const double margin_m = std::max(least_margin_m, margin_share * longer_m);
        const auto widen = [&](double& from, double& to) {
            const double lacking_m = std::max(0.0, narrowest_part * longer_m - (to - from)) / 2.0 + margin_m;
            from -= lacking_m;
            to += lacking_m;
        };
        widen(left_, right_);
        widen(low_, high_);
    }

    double left_ = 1e30, right_ = -1e30, low_ = 1e30, high_ = -1e30;
};

void draw_line(MapCanvas& canvas, const std::vector<MapPlace>& line, const Series& series) {
    Points points;
    for (const MapPlace& place : line)
        points.push_back(canvas.place(place));
    canvas.path(points, line_style(series));
}

/// Whether a way was considered for the vehicle that is not its own.
bool draw_considered(MapCanvas& canvas, const ScenarioFacts& scenario, const ChangedWay& change,
                     const RoadMap& near) {
    bool any = false;
    for (const ConsideredEdge& one : scenario.map->considered) {
        const MapEdge& edge = scenario.roads->edges[one.edge];
        if (one.vehicle != change.vehicle || one.replication != change.replication ||
            !near.find_edge(edge.id))
            continue;
        canvas.edge(edge, "way considered");
        any = true;
    }
    return any;
}

/// The words stand on the side from which no way comes, where they have room.
void draw_end(MapCanvas& canvas, const MapPlace& place, const MapPlace& next, const char* words) {
    constexpr double room = 48.0;
    const auto [x, y] = canvas.place(place);
    canvas.circle(x, y, 4.0, "dot s0");
    const bool is_right = x < room || (x < Canvas::width - room && next.first <= place.first);
    canvas.text(is_right ? x + 8.0 : x - 8.0, y + 4.0, words,
                is_right ? Canvas::Anchor::start : Canvas::Anchor::end, "halo");
}

double length_km(const RoadMap& roads, const std::vector<std::size_t>& edges) {
    double sum_m = 0.0;
    for (const std::size_t edge : edges)
        sum_m += roads.edges[edge].length_m;
    return sum_m / metres_per_km;
}

DataTable data_of(const ScenarioFacts& scenario) {
    const RoadMap& roads = *scenario.roads;
    DataTable table{{"Vehicle", "replication", "way", "edges", "length, km", "time, s"}, {}};
    for (const ChangedWay& change : scenario.map->changed_ways) {
        const auto add = [&](const char* way, const std::vector<std::size_t>& edges, double time_s) {
            std::string ids;
            for (const std::size_t edge : edges)
                ids += (ids.empty() ? "" : " ") + roads.edges[edge].id;
            table.rows.push_back({change.vehicle, grouped(change.replication), way, ids,
                                  number(length_km(roads, edges), typeset(2)), number(time_s, typeset(1))});
        };
        add("baseline", change.baseline, change.baseline_s);
        add("condition", change.condition, change.condition_s);
    }
    return table;
}

}  // namespace

bool is_shown_trip(const ScenarioFacts& scenario, const ChangedWay& change) {
    return !scenario.journeys.empty() && scenario.journeys.front().vehicle == change.vehicle &&
           scenario.journeys.front().replication == change.replication;
}

Figure ways_figure(const ScenarioFacts& scenario) {
    const ConditionFacts* const drawn = scenario.of_map();
    if (drawn == nullptr || !scenario.roads) return {};
    const ChangedWay* const change = shown_change(scenario);
    if (change == nullptr) return {};
    const ConditionFacts& condition = *drawn;
    const ConditionFacts& baseline = *scenario.baseline_of(condition);
    const Surroundings around(*scenario.roads, *change);
    if (around.before.size() < 2 || around.after.size() < 2) return {};
    MapCanvas canvas(fmt::format("{}: the ways of {} with and without {}", scenario.name, change->vehicle,
                                 condition.label()),
                     around.roads);
    canvas.edges(all_edges(around.roads), "road");
    const Series with{scenario.place_of(condition.name()), Series::Weight::lead};
    const Series without{scenario.place_of(condition.baseline)};
    draw_line(canvas, around.after, with);
    draw_line(canvas, around.before, without);
    const bool has_others = draw_considered(canvas, scenario, *change, around.roads);
    canvas.incidents(around.roads);
    draw_end(canvas, around.after.front(), around.after[1], "start");
    draw_end(canvas, around.after.back(), around.after[around.after.size() - 2], "end");
    canvas.scale_bar();
    canvas.credit(scenario.attribution);
    std::vector<LegendEntry> legend = {
        line_entry(without, fmt::format("{}: {} km, {} s", baseline.label(),
                                        number(length_km(*scenario.roads, change->baseline), typeset(2)),
                                        number(change->baseline_s, typeset(0)))),
        line_entry(with, fmt::format("{}: {} km, {} s", condition.label(),
                                     number(length_km(*scenario.roads, change->condition), typeset(2)),
                                     number(change->condition_s, typeset(0))))};
    if (has_others) legend.push_back(considered_entry());
    if (!around.roads.incidents.empty()) legend.push_back({incident_sign, "road blocked for a while"});
    canvas.legend(legend);
    return {"ways-" + scenario.name, "One trip on two ways", canvas.finish(),
            fmt::format("Vehicle {}, replication {}. Of {} that both conditions have, {} took another way "
                        "under {}; {}. Lengths and times begin with the first whole edge.",
                        change->vehicle, change->replication, core::counted(scenario.map->trips, "trip"),
                        grouped(scenario.map->changed_ways.size()), condition.label(),
                        is_shown_trip(scenario, *change) ? "it is the trip over time, too"
                                                         : "of them its gain is the median"),
            data_of(scenario)};
}

}  // namespace clearway::report::detail
