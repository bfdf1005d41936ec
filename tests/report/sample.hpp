#pragma once

#include <cmath>
#include <initializer_list>
#include <string>

#include "report/facts.hpp"

namespace clearway::report::tests {

/// mean, half width
inline MaybeEstimate around(double mean, double half_width, std::size_t count = 20) {
    return analysis::Estimate{count, mean, 0.0, analysis::Interval{mean - half_width, mean + half_width}};
}

inline analysis::MetricSummary& metric(ConditionFacts& facts, std::string_view name) {
    return const_cast<analysis::MetricSummary&>(facts.metric(name));
}
inline MaybeEstimate& value(ConditionFacts& facts, Measure measure) {
    return metric(facts, info(measure).field).estimate;
}
inline analysis::Comparison& comparison(ConditionFacts& facts, Measure measure) {
    auto& comparison = metric(facts, info(measure).field).comparison;
    return comparison ? *comparison : comparison.emplace();
}
inline MaybeEstimate& difference(ConditionFacts& facts, Measure measure) {
    return comparison(facts, measure).difference;
}
/// An estimate by its mean and the ends of its interval.
inline MaybeEstimate between(double mean, double low, double high, std::size_t count = 20) {
    return analysis::Estimate{count, mean, 0.0, analysis::Interval{low, high}};
}

/// A count that all runs have together.
inline void set_total(ConditionFacts& facts, std::string_view name, double total) {
    metric(facts, name).values = {total};
}

/// A condition with all metrics, which have no values.
inline ConditionFacts empty_condition(const std::string& name, const std::string& title) {
    ConditionFacts facts;
    facts.condition.name = name;
    facts.title = title;
    for (const analysis::MetricInfo& info : analysis::all_metrics())
        facts.metrics.emplace_back().metric = info;
    for (const Measure derived : {Measure::gap_closed, Measure::unfinished})
        facts.metrics.emplace_back().metric.name = info(derived).field;
    return facts;
}

inline ConditionFacts condition(const std::string& name, const std::string& title, double travel_time_s) {
    ConditionFacts facts = empty_condition(name, title);
    facts.recipe = "perfect sensing; no repair; no policy";
    facts.complete_runs = 20;
    facts.emergency = {.arrived = 58, .running_at_end = 1, .teleported = 1, .not_inserted = 0, .removed = 0};
    facts.others = {.arrived = 740, .running_at_end = 0, .teleported = 0, .not_inserted = 0, .removed = 0};
    value(facts, Measure::emergency_waiting_time) = around(travel_time_s / 9.0, 1.1);
    value(facts, Measure::emergency_depart_delay) = around(0.31, 0.12);
    value(facts, Measure::waiting_time) = around(12.4, 2.2);
    value(facts, Measure::emergency_restricted_time) = around(travel_time_s, 4.4);
    value(facts, Measure::emergency_travel_time) = around(travel_time_s, 4.4);
    value(facts, Measure::emergency_time_loss) = around(travel_time_s / 4.0, 3.1);
    value(facts, Measure::other_time_loss) = around(31.7, 2.6);
    value(facts, Measure::depart_delay) = around(0.42, 0.1);
    value(facts, Measure::collisions) = around(0.05, 0.1);
    value(facts, Measure::teleports) = around(0.05, 0.1);
    value(facts, Measure::unfinished) = around(0.05, 0.1);
    facts.travel_time.median = around(0.93 * travel_time_s, 4.0);
    facts.travel_time.percentile_95 = around(1.4 * travel_time_s, 9.0);
    facts.distribution.all = 60;
    facts.distribution.arrived = 58;
    for (int rank = 1; rank <= 58; ++rank) {
        const double seconds = travel_time_s * (0.7 + 0.3 * std::pow(rank / 29.0, 1.4));
        facts.distribution.points.push_back({seconds, rank / 60.0});
    }
    return facts;
}

/// Twenty pairs whose mean difference is that of `travel_time`.
inline void add_pairs(ConditionFacts& facts, const analysis::Estimate& travel_time) {
    for (const Measure measure : {Measure::emergency_restricted_time, Measure::emergency_travel_time,
                                  Measure::other_time_loss, Measure::collisions}) {
        analysis::Comparison& paired = comparison(facts, measure);
        paired.complete_pairs = 20;
        paired.incomplete_pairs = 1;
        paired.vehicles_left_out = 2;
        paired.bootstrap = paired.median_interval = travel_time.interval;
        paired.median = travel_time.mean;
        paired.effect_size = -1.87;
        paired.t_p = 0.0004;
        paired.wilcoxon_p = 0.0012;
        paired.holm_p = 0.0016;
    }
    analysis::Comparison& times = comparison(facts, Measure::emergency_restricted_time);
    for (int pair = 0; pair < 20; ++pair) {
        times.baseline_values.push_back(101.3 + 9.0 * std::sin(1.7 * pair));
        times.condition_values.push_back(times.baseline_values.back() + travel_time.mean +
                                         5.0 * std::cos(2.3 * pair));
    }
    facts.precision = Precision{{}, 6.0, 141};
    for (std::uint64_t n = 5; n <= 20; ++n)
        facts.precision->points.push_back({n, 14.0 / std::sqrt(static_cast<double>(n))});
    for (int approach = 0; approach < 12; ++approach) {
        const MaybeEstimate cost = around(240.0 / (1 + approach) * (approach % 3 == 1 ? -1.0 : 1.0), 60.0);
        facts.approaches.push_back(
            {"edge" + std::to_string(approach), 1200.0, cost, cost, around(3.0, 5.0), cost, 35.5, 1.25});
    }
    facts.recovery.emplace().recovered_by_s = 75.0;
    for (int offset = -60; offset <= 240; offset += 5)
        facts.recovery->points.push_back(
            {static_cast<double>(offset), around(3.0 * std::exp(-std::pow((offset - 30) / 40.0, 2.0)), 0.8)});
    set_total(facts, "leases_issued", 812);
    set_total(facts, "leases_refused", 31);
    set_total(facts, "leases_expired", 640);
}

inline void compare(ConditionFacts& facts, const MaybeEstimate& travel_time, const MaybeEstimate& others) {
    facts.baseline = "baseline";
    add_pairs(facts, *travel_time);
    for (const MeasureInfo& measure : measures())
        difference(facts, measure.measure) = around(0.0, 0.2);
    difference(facts, Measure::emergency_restricted_time) = travel_time;
    difference(facts, Measure::emergency_travel_time) = travel_time;
    difference(facts, Measure::emergency_time_loss) = travel_time;
    difference(facts, Measure::emergency_waiting_time) = around(-1.84, 0.9);
    difference(facts, Measure::other_time_loss) = others;
    value(facts, Measure::gap_closed) = around(0.41, 0.13);
}

/// A small grid of streets with two stations.
inline RoadMap roads() {
    RoadMap roads;
    constexpr std::size_t size = 6;
    const auto street = [&](bool east, std::size_t row, std::size_t column) {
        MapEdge edge;
        edge.id = (east ? "east" : "north") + std::to_string(row) + std::to_string(column);
        const double x = 200.0 * static_cast<double>(column);
        const double y = 150.0 * static_cast<double>(row);
        edge.shape = {{x, y}, {x + (east ? 200.0 : 0.0), y + (east ? 0.0 : 150.0)}};
        edge.length_m = east ? 200.0 : 150.0;
        edge.limit_mps = 13.9;
        edge.signal = true;
        const std::size_t next_row = row + (east ? 0 : 1);
        const std::size_t next_column = column + (east ? 1 : 0);
        if (next_column < size) edge.to.push_back(2 * (next_row % size * size + next_column));
        if (next_row < size) edge.to.push_back(2 * (next_row * size + next_column % size) + 1);
        roads.edges.push_back(edge);
    };
    for (std::size_t row = 0; row < size; ++row) {
        for (std::size_t column = 0; column < size; ++column) {
            street(true, row, column);
            street(false, row, column);
        }
    }
    roads.signals = {{"J1", {200.0, 0.0}}, {"J2", {400.0, 0.0}}};
    roads.stations = {{"east00", "fire_station", "Station <1>"}, {"north00", "ambulance_station", ""}};
    return roads;
}

/// The first street of the grid was driven.
inline ScenarioMap map(const RoadMap& roads) {
    ScenarioMap map;
    map.condition = "graph_simulation";
    map.times = {{0, 20, 31.0, 18.5},
                 {2, 20, 40.0, 38.0},
                 {4, 19, 18.0, 18.1},
                 {7, 12, 15.0, 16.2},
                 {9, 4, 15.0, 23.0}};
    map.holds = {{0, 1.5, 22.0}, {1, 1.0, 9.5}};
    map.reach = reach_of(roads, map.times, {0, 1}, 240.0);
    return map;
}

/// A helpful, a harmful and an ineffective condition beside the baseline, and the floor.
inline ScenarioFacts scenario(const std::string& name) {
    ScenarioFacts facts;
    facts.name = name;
    facts.published_as = name;
    facts.replications = 20;
    facts.conditions = {condition("baseline", "Baseline", 101.3),
                        condition("graph_simulation", "Graph made by simulation attributes", 88.9),
                        condition("graph_graphsage", "GraphSAGE, corrected inputs", 92.2),
                        condition("b10_no_repair", "Same failures, no repair", 130.8),
                        condition("b10_dead_reckoning", "Same failures, dead reckoning", 100.7),
                        condition("solo", "Alone on the road, signals open", 70.2)};
    for (const char* const title : {"Baseline", "Graph made by simulation attributes"}) {
        facts.journeys.push_back({"emergency0",
                                  title,
                                  0,
                                  {{0.0, 0.0}, {30.0, 250.0}, {50.0, 255.0}, {90.0, 820.0}},
                                  {{"J1", "red", 260.0, 0.0, 48.0},
                                   {"J1", "green", 260.0, 48.0, 90.0},
                                   {"J2", "green", 600.0, 0.0, 60.0},
                                   {"J2", "yellow", 600.0, 60.0, 63.0},
                                   {"J2", "red", 600.0, 63.0, 90.0}}});
    }
    compare(facts.conditions[1], around(-12.4, 3.1), around(0.4, 1.2));
    compare(facts.conditions[2], around(-9.1, 3.6), around(2.4, 1.2));
    compare(facts.conditions[3], around(29.5, 8.5), around(3.9, 2.2));
    compare(facts.conditions[4], around(-0.6, 2.8), around(-0.1, 1.0));
    facts.roads = roads();
    facts.map = map(*facts.roads);
    facts.streets["edge2"] =
        "Stra\u00dfe der sehr langen und noch l\u00e4ngeren Namen am \u00e4u\u00dfersten Rand der Stadt";
    if (name != std::string("city")) facts.map->reach.reset();  // the others have no stations
    return facts;
}

inline StudyFacts study(std::initializer_list<const char*> names) {
    StudyFacts facts;
    facts.title = "Clearway: dissertation";
    for (const char* const name : names) {
        facts.scenarios.push_back(scenario(name));
    }
    facts.command = "./clearway study studies/dissertation.toml";
    facts.provenance = {{"Clearway", "0.1.0"}, {"SUMO", "1.15.0"}, {"study seed", "1"}};
    for (const char* const reading : {"true links only", "candidate pairs"}) {
        LossCurve curve;
        curve.title = reading;
        curve.constant_loss = 0.31;
        for (int epoch = 0; epoch < 100; ++epoch) {
            curve.epoch.push_back(epoch);
            curve.train.push_back(0.1 + 0.6 * std::exp(-epoch / 12.0));
            curve.test.push_back(0.14 + 0.55 * std::exp(-epoch / 14.0));
        }
        facts.curves.push_back(curve);
    }
    return facts;
}

}  // namespace clearway::report::tests
