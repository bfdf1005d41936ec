
#include <fmt/format.h>

#include "report/detail/figures.hpp"
#include "report/detail/map_canvas.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

constexpr double kilometre = 1000.0;

/// What is reached, by the classes that draw it. Lost reach is drawn although policies seldom cause it.
struct Reached {
    std::vector<const MapEdge*> both;
    std::vector<const MapEdge*> gained;
    std::vector<const MapEdge*> lost;
    std::vector<const MapEdge*> none;
};

Reached reached_within(const RoadMap& roads, const Reach& reach, double within_s) {
    Reached reached;
    for (std::size_t edge = 0; edge < reach.edges.size(); ++edge) {
        const auto& [before_s, after_s, driven] = reach.edges[edge];
        const bool before = before_s && *before_s <= within_s;
        const bool after = after_s && *after_s <= within_s;
        auto& target = before && after ? reached.both
                       : after         ? reached.gained
                       : before        ? reached.lost
                                       : reached.none;
        target.push_back(&roads.edges[edge]);
    }
    return reached;
}

double driven_share(const RoadMap& roads, const Reach& reach) {
    double driven_m = 0.0;
    double all_m = 0.0;
    for (std::size_t edge = 0; edge < reach.edges.size(); ++edge) {
        all_m += roads.edges[edge].length_m;
        if (reach.edges[edge].driven) driven_m += roads.edges[edge].length_m;
    }
    return all_m > 0.0 ? driven_m / all_m : 0.0;
}

/// Length reached by whole minutes, until nothing more is reached.
DataTable data_of(const RoadMap& roads, const Reach& reach) {
    DataTable table{{"within, min", "baseline, km", "condition, km", "difference, km"}, {}};
    constexpr int most_minutes = 60;
    double last_m = -1.0;
    for (int minute = 1; minute <= most_minutes; ++minute) {
        const double before_m = reach.baseline_m(roads, 60.0 * minute);
        const double after_m = reach.condition_m(roads, 60.0 * minute);
        if (before_m + after_m == last_m) break;
        last_m = before_m + after_m;
        table.rows.push_back({std::to_string(minute), number(before_m / kilometre, typeset(2)),
                              number(after_m / kilometre, typeset(2)),
                              number((after_m - before_m) / kilometre, typeset(2, Sign::always))});
    }
    return table;
}

}  // namespace

Figure reach_figure(const ScenarioFacts& scenario) {
    const ConditionFacts* const drawn = scenario.of_map();
    if (drawn == nullptr || !scenario.map->reach || !is_drawable(*scenario.roads)) return {};
    // Where chance could be all of a difference, a map would show chance, street by street.
    const ConditionFacts& condition = *drawn;
    const Effect effect = effect_of(condition, primary);
    if (effect != Effect::better && effect != Effect::worse) return {};
    const RoadMap& roads = *scenario.roads;
    const Reach& reach = *scenario.map->reach;
    const double within_s = 60.0 * reach.minutes;
    const std::string minutes = number(reach.minutes, typeset(0));
    const Reached reached = reached_within(roads, reach, within_s);
    MapCanvas canvas(fmt::format("{}: reached within {} min", scenario.name, minutes), roads);
    canvas.edges(reached.none, "road");
    canvas.edges(reached.both, "way reached");
    canvas.edges(reached.lost, "way worse much");
    canvas.edges(reached.gained, "way better much");
    canvas.stations(roads);
    canvas.scale_bar();
    std::vector<LegendEntry> entries = {{station_sign, station_words(roads)},
                                        stripe_entry("way reached", "reached without and with"),
                                        stripe_entry("way better much", "reached only with it")};
    if (!reached.lost.empty()) entries.push_back(stripe_entry("way worse much", "reached only without it"));
    entries.push_back(stripe_entry("road", "not reached"));
    canvas.legend(entries);
    canvas.credit(scenario.attribution);
    const std::string note = fmt::format(
        "Within {} min, half a usual trip, from the nearest {}: {} km of road without and {} km with {} "
        "(means of the replications). On {} % of the network\u2019s length the time is that of emergency "
        "vehicles which drove there; elsewhere it is estimated as {} times the time at the limit, without "
        "and with "
        "it.",
        minutes, station_words(roads), number(reach.baseline_m(roads, within_s) / kilometre, typeset(1)),
        number(reach.condition_m(roads, within_s) / kilometre, typeset(1)), condition.label(),
        number(100.0 * driven_share(roads, reach), typeset(0)), number(reach.delay, typeset(2)));
    return {"reach-" + scenario.name, fmt::format("Reached within {} minutes", minutes), canvas.finish(),
            note, data_of(roads, reach)};
}

}  // namespace clearway::report::detail
