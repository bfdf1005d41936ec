#pragma once

#include <cmath>
#include <initializer_list>
#include <string>

#include "report/facts.hpp"

namespace clearway::report::tests {

/// mean, half width
inline Estimate around(double mean, double half_width, std::uint64_t count = 20) {
    return {mean, mean - half_width, mean + half_width, count};
}

inline ConditionFacts condition(const std::string& name, const std::string& title, double travel_time_s) {
    ConditionFacts facts;
    facts.name = name;
    facts.title = title;
    facts.recipe = "perfect sensing; no repair; no policy";
    facts.runs = 20;
    facts.emergency = {.arrived = 58, .running = 1, .teleported = 1, .not_inserted = 0, .removed = 0};
    facts.others = {.arrived = 740, .running = 0, .teleported = 0, .not_inserted = 0, .removed = 0};
    facts.outcome(Measure::emergency_waiting_time).value = around(travel_time_s / 9.0, 1.1);
    facts.outcome(Measure::emergency_depart_delay).value = around(0.31, 0.12);
    facts.outcome(Measure::waiting_time).value = around(12.4, 2.2);
    facts.outcome(Measure::emergency_travel_time).value = around(travel_time_s, 4.4);
    facts.outcome(Measure::emergency_time_loss).value = around(travel_time_s / 4.0, 3.1);
    facts.outcome(Measure::other_time_loss).value = around(31.7, 2.6);
    facts.outcome(Measure::depart_delay).value = around(0.42, 0.1);
    facts.outcome(Measure::collisions).value = around(0.05, 0.1);
    facts.outcome(Measure::teleports).value = around(0.05, 0.1);
    facts.outcome(Measure::unfinished).value = around(0.05, 0.1);
    facts.travel_time.all = 60;
    facts.travel_time.arrived = 58;
    for (int rank = 1; rank <= 58; ++rank) {
        const double seconds = travel_time_s * (0.7 + 0.3 * std::pow(rank / 29.0, 1.4));
        facts.travel_time.points.push_back({seconds, rank / 60.0});
    }
    return facts;
}

inline void compare(ConditionFacts& facts, const Estimate& travel_time, const Estimate& others) {
    facts.baseline = 0;
    for (Outcome& outcome : facts.outcomes) {
        outcome.difference = around(0.0, 0.2);
    }
    facts.outcome(Measure::emergency_travel_time).difference = travel_time;
    facts.outcome(Measure::emergency_time_loss).difference = travel_time;
    facts.outcome(Measure::emergency_waiting_time).difference = around(-1.84, 0.9);
    facts.outcome(Measure::other_time_loss).difference = others;
    facts.outcome(Measure::gap_closed).value = around(0.41, 0.13);
}

/// A helpful, a harmful and an ineffective condition beside the baseline, and the floor.
inline ScenarioFacts scenario(const std::string& name) {
    ScenarioFacts facts;
    facts.name = name;
    facts.replications = 20;
    facts.conditions = {condition("baseline", "Baseline", 101.3),
                        condition("graph_simulation", "Graph made by simulation attributes", 88.9),
                        condition("graph_graphsage", "Graph made by GraphSAGE", 92.2),
                        condition("b10_no_repair", "Same failures, no repair", 130.8),
                        condition("b10_dead_reckoning", "Same failures, dead reckoning", 100.7),
                        condition("solo", "Alone on the road, signals open", 70.2)};
    compare(facts.conditions[1], around(-12.4, 3.1), around(0.4, 1.2));
    compare(facts.conditions[2], around(-9.1, 3.6), around(2.4, 1.2));
    compare(facts.conditions[3], around(29.5, 8.5), around(3.9, 2.2));
    compare(facts.conditions[4], around(-0.6, 2.8), around(-0.1, 1.0));
    return facts;
}

inline StudyFacts study(std::initializer_list<const char*> names) {
    StudyFacts facts;
    facts.title = "Clearway: dissertation";
    for (const char* const name : names) {
        facts.scenarios.push_back(scenario(name));
    }
    facts.command = "./clearway reproduce --seeds 20";
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
