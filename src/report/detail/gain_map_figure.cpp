#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/map_canvas.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::size_t drawn_losses = 8;  // approaches with the largest shown losses; the data list all

/// Seconds gained on an edge as it is drawn: colour says the direction, width how much.
struct Band {
    double from_s;  ///< Gains from here on.
    const char* style;
    const char* words;
};
constexpr std::array<Band, 5> bands = {{{5.0, "way better much", "gain 5 s or more on the edge"},
                                        {0.5, "way better", "gain 0.5 to 5 s"},
                                        {-0.5, "way", "less than 0.5 s"},
                                        {-5.0, "way worse", "loss 0.5 to 5 s"},
                                        {-1e30, "way worse much", "loss 5 s or more"}}};

/// One or a few trips say nothing of an edge: what one of them met there by chance is all of the mean.
constexpr std::uint64_t fewest_passages = 6;
constexpr Band too_few = {0.0, "way few", "up to 5 passages: too few to say"};

const Band& band_of(const EdgeTimes& times) {
    if (times.passages < fewest_passages) return too_few;
    return *std::ranges::find_if(bands, [&](const Band& band) { return times.gain_s() >= band.from_s; });
}

/// How many trips more than in the baseline drove each edge, of those that have two ways.
using WayCounts = std::map<std::size_t, std::int64_t>;

WayCounts way_counts(const ScenarioMap& map) {
    WayCounts counts;
    for (const ChangedWay& change : map.changed_ways) {
        for (const std::size_t edge : std::set(change.condition.begin(), change.condition.end()))
            ++counts[edge];
        for (const std::size_t edge : std::set(change.baseline.begin(), change.baseline.end()))
            --counts[edge];
    }
    std::erase_if(counts, [](const auto& count) { return count.second == 0; });
    return counts;
}

/// Broad, below the ways.
void draw_changed(MapCanvas& canvas, const RoadMap& roads, const WayCounts& counts) {
    for (const auto& [edge, trips] : counts)
        canvas.edge(roads.edges[edge], trips > 0 ? "way taken" : "way left");
}

/// Decisions by edge, of ways that were considered and not taken.
std::map<std::size_t, std::uint64_t> considered_edges(const ScenarioMap& map) {
    std::map<std::size_t, std::uint64_t> decisions;
    for (const ConsideredEdge& one : map.considered)
        decisions[one.edge] += one.decisions;
    return decisions;
}

/// The ways, small changes first, so that large ones lie on top.
void draw_ways(MapCanvas& canvas, const RoadMap& roads, const ScenarioMap& map) {
    std::vector<EdgeTimes> times = map.times;
    std::ranges::stable_sort(times, {}, [](const EdgeTimes& one) {
        return &band_of(one) == &too_few ? -1.0 : std::abs(one.gain_s());
    });
    for (const EdgeTimes& one : times)
        canvas.edge(roads.edges[one.edge], band_of(one).style);
}

void draw_holds(MapCanvas& canvas, const RoadMap& roads, const ScenarioMap& map) {
    double longest_s = 0.0;
    for (const SignalHolds& one : map.holds)
        longest_s = std::max(longest_s, one.held_s);
    constexpr double roomy = 30.0;  // more of the usual size hide each other
    const double size = std::clamp(std::sqrt(roomy / static_cast<double>(map.holds.size() + 1)), 0.4, 1.0);
    for (const SignalHolds& one : map.holds) {
        if (one.held_s <= 0.0) continue;
        const auto [x, y] = canvas.place(roads.signals[one.signal].place);
        canvas.circle(x, y, size * (3.0 + 4.0 * std::sqrt(one.held_s / longest_s)), "held");
    }
}

/// Approaches whose interval lies above 0, the largest losses first.
std::vector<const analysis::ApproachCost*> losing_approaches(const ConditionFacts& condition) {
    std::vector<const analysis::ApproachCost*> losing;
    for (const analysis::ApproachCost& approach : condition.approaches) {
        const analysis::Interval* const interval = shown_interval(approach.difference);
        if (interval != nullptr && interval->low > 0.0) losing.push_back(&approach);
    }
    std::ranges::stable_sort(losing, std::greater{}, [](const analysis::ApproachCost* approach) {
        return approach->difference->mean;
    });
    return losing;
}

/// A triangle at the end of the approach, where its vehicles wait.
void draw_loss(MapCanvas& canvas, const MapEdge& edge) {
    if (edge.shape.empty()) return;
    const auto [x, y] = canvas.place(edge.shape.back());
    canvas.add(fmt::format("<path class=\"losing\" d=\"M{:.1f} {:.1f}l5 -9h-10z\"/>\n", x, y));
}

/// A cross at the junction of a lock; paler where only the baseline locked.
void draw_locks(MapCanvas& canvas, const RoadMap& roads, const ScenarioMap& map) {
    for (const MapLocks& one : map.locks) {
        if (roads.edges[one.edge].shape.empty()) continue;
        const auto [x, y] = canvas.place(roads.edges[one.edge].shape.back());
        canvas.add(fmt::format("<path class=\"lock{}\" d=\"M{:.1f} {:.1f}l6 6m0 -6l-6 6\"/>\n",
                               one.condition == 0 ? " before" : "", x - 3.0, y - 3.0));
    }
}

/// A ring in the middle of the edge.
void draw_calls(MapCanvas& canvas, const RoadMap& roads) {
    for (const MapCall& one : roads.calls) {
        const auto edge = roads.find_edge(one.edge);
        if (!edge || roads.edges[*edge].shape.empty()) continue;
        const std::vector<MapPlace>& shape = roads.edges[*edge].shape;
        const auto [x, y] = canvas.place(shape[shape.size() / 2]);
        canvas.add(fmt::format("<circle class=\"call\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"/>\n", x, y));
    }
}

/// After the ids of edges, their streets.
void add_streets(const ScenarioFacts& scenario, DataTable& table) {
    constexpr std::ptrdiff_t column = 2;
    table.head.insert(table.head.begin() + column, "street");
    for (std::vector<std::string>& row : table.rows) {
        const auto street = scenario.streets.find(row[1]);
        row.insert(row.begin() + column, street == scenario.streets.end() ? "" : street->second);
    }
}

DataTable data_of(const ScenarioFacts& scenario, const WayCounts& counts,
                  const std::vector<const analysis::ApproachCost*>& losing) {
    const RoadMap& roads = *scenario.roads;
    const ScenarioMap& map = *scenario.map;
    DataTable table{{"What", "id", "passages or holds", "baseline, s", "condition, s", "gain, s"}, {}};
    std::vector<EdgeTimes> times = map.times;
    std::ranges::stable_sort(times, std::greater{}, &EdgeTimes::gain_s);
    for (const EdgeTimes& one : times)
        table.rows.push_back({"edge", roads.edges[one.edge].id, grouped(one.passages),
                              number(one.baseline_s, typeset(2)), number(one.condition_s, typeset(2)),
                              number(one.gain_s(), typeset(2, Sign::always))});
    for (const SignalHolds& one : map.holds)
        table.rows.push_back({"signal held, per run", roads.signals[one.signal].id,
                              number(one.holds, typeset(2)), "", number(one.held_s, typeset(1)), ""});
    for (const auto& [edge, trips] : counts)
        table.rows.push_back({"trips more than in the baseline", roads.edges[edge].id,
                              number(static_cast<double>(trips), typeset(0, Sign::always)), "", "", ""});
    for (const auto& [edge, decisions] : considered_edges(map))
        table.rows.push_back(
            {"decisions with it on a way not taken", roads.edges[edge].id, grouped(decisions), "", "", ""});
    for (const MapIncident& one : roads.incidents)
        table.rows.push_back({"blocked, from and to, s", one.edge, "", number(one.from_s, typeset(0)),
                              number(one.to_s, typeset(0)), ""});
    for (const MapCall& one : roads.calls)
        table.rows.push_back(
            {"call, at s", one.edge, grouped(one.units), number(one.at_s, typeset(0)), "", ""});
    for (const MapLocks& one : map.locks)
        table.rows.push_back({"locks, all runs", roads.edges[one.edge].id, "", grouped(one.baseline),
                              grouped(one.condition), ""});
    for (const analysis::ApproachCost* const approach : losing)
        table.rows.push_back({"others lose, s per run", approach->edge, "",
                              number_or_dash(approach->baseline_s, typeset(0)), "",
                              number(-approach->difference->mean, typeset(0, Sign::always))});
    if (!scenario.streets.empty()) add_streets(scenario, table);
    return table;
}

std::vector<LegendEntry> entries_of(const RoadMap& roads, const ScenarioMap& map, bool losing) {
    std::vector<LegendEntry> entries;
    const auto add = [&](const Band& band) {
        if (std::ranges::any_of(map.times, [&](const EdgeTimes& one) { return &band_of(one) == &band; }))
            entries.push_back(stripe_entry(band.style, band.words));
    };
    std::ranges::for_each(bands, add);
    add(too_few);
    if (!map.holds.empty()) entries.push_back(dot_entry("held", "signal held, larger: longer"));
    if (!map.locks.empty())
        entries.push_back({"<path class=\"lock\" d=\"M17 3l6 6m0 -6l-6 6\"/>",
                           "vehicles locked each other (pale: baseline)"});
    if (!map.changed_ways.empty()) {
        entries.push_back(stripe_entry("way taken", "more EVs than in the baseline"));
        entries.push_back(stripe_entry("way left", "fewer EVs"));
    }
    if (!map.considered.empty()) entries.push_back(considered_entry());
    if (!roads.incidents.empty()) entries.push_back({incident_sign, "road blocked for a while"});
    if (!roads.calls.empty())
        entries.push_back({"<circle class=\"call\" cx=\"20\" cy=\"6\" r=\"5\"/>", "EVs are called here"});
    if (!roads.stations.empty()) entries.push_back({station_sign, station_words(roads)});
    if (losing)
        entries.push_back({"<path class=\"losing\" d=\"M20 10l5 -9h-10z\"/>", "others lose time here"});
    return entries;
}

}  // namespace

Figure gain_map_figure(const ScenarioFacts& scenario) {
    const ConditionFacts* const drawn = scenario.of_map();
    if (drawn == nullptr || !is_drawable(*scenario.roads)) return {};
    const ConditionFacts& condition = *drawn;
    const RoadMap& roads = *scenario.roads;
    const ScenarioMap& map = *scenario.map;
    MapCanvas canvas(fmt::format("{}: where {} gains and costs time", scenario.name, condition.label()),
                     roads);
    canvas.edges(all_edges(roads), "road");
    const WayCounts counts = way_counts(map);
    draw_changed(canvas, roads, counts);
    draw_ways(canvas, roads, map);
    for (const auto& [edge, decisions] : considered_edges(map))
        canvas.edge(roads.edges[edge], "way considered");
    draw_holds(canvas, roads, map);
    draw_locks(canvas, roads, map);
    canvas.incidents(roads);
    draw_calls(canvas, roads);
    canvas.stations(roads);
    const std::vector<const analysis::ApproachCost*> losing = losing_approaches(condition);
    for (std::size_t row = 0; row < std::min(losing.size(), drawn_losses); ++row) {
        if (const auto edge = roads.find_edge(losing[row]->edge)) draw_loss(canvas, roads.edges[*edge]);
    }
    canvas.scale_bar();
    canvas.credit(scenario.attribution);
    canvas.legend(entries_of(roads, map, !losing.empty()));
    std::string note = fmt::format(
        "Seconds that an emergency vehicle gains on an edge and the junction behind it under {}: means over "
        "all passages that it shares with the baseline. Single edges have no interval; those passed too "
        "seldom to "
        "say may hold much of the gain, which the tables sum over a trip.",
        condition.label());
    if (!map.changed_ways.empty())
        note += fmt::format(" {} of {} took another way than under the baseline.",
                            grouped(map.changed_ways.size()), core::counted(map.trips, "trip"));
    if (losing.size() > drawn_losses)
        note += fmt::format(
            " Of {} approaches on which others lose time, the {} with the largest losses are marked.",
            losing.size(), drawn_losses);
    return {"map-" + scenario.name, "Where time is gained and lost against the baseline", canvas.finish(),
            note, data_of(scenario, counts, losing)};
}

}  // namespace clearway::report::detail
