#pragma once

#include <cstddef>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "report/equipment.hpp"

namespace clearway::report {

inline analysis::Estimate about(double mean, double half_width) {
    return {10, mean, 1.0, analysis::Interval{mean - half_width, mean + half_width}};
}

/// Twelve signals, ten of which EVs pass; two of these ten are candidates by name here. The first two bring
/// 30 and 42 of 50 s; the gain of the second is not shown.
inline EquipmentFacts two_of_twelve() {
    EquipmentFacts facts;
    facts.scenario = "town";
    facts.title = "A town";
    facts.condition = "corridor";
    facts.command = "clearway equip town <&>";
    facts.study = {"clearway", "run", "town"};
    facts.seed = 7;
    facts.fresh_seed = 8;
    facts.replications = 10;
    facts.budget = 5;
    facts.met = {8, 5, 15};
    facts.signals = 12;
    facts.not_passed = 2;
    facts.runs = 140;
    facts.all_gain = about(50.0, 5.0);
    facts.all_others = about(2.0, 1.0);
    facts.baseline_s = about(151.0, 9.0);
    facts.none_s = about(150.0, 9.0);
    facts.all_s = about(100.0, 8.0);
    facts.alone_s = about(95.0, 7.0);
    facts.candidates = {{1, "west", "", 0.1, about(1.0, 2.0), true, std::nullopt},
                        {4, "north<&>", "Gate <Road> / High Street", 0.45, about(31.0, 4.0), false, 1},
                        {9, "south of the old town's gate", "", 0.2, about(12.0, 3.0), false, 2}};
    facts.candidates[0].gain->n = 5;
    facts.ranked = {{4, "north<&>", "Gate <Road> / High Street", about(30.0, 4.0), about(30.0, 4.0),
                     about(0.5, 0.2), about(31.0, 4.0)},
                    {9, "south of the old town's gate", "", about(12.0, 13.0), about(42.0, 4.0),
                     about(1.0, 0.4), about(14.0, 3.0)}};
    facts.end = analysis::EquipEnd::no_gain;
    return facts;
}

/// The roads of the three of them, 400 m by 300 m.
inline RoadMap three_roads() {
    RoadMap roads;
    roads.edges.push_back({"a", {}, true, 500.0, 14.0, {{0.0, 0.0}, {400.0, 300.0}}});
    roads.signals = {{"west", {0.0, 0.0}}, {"north<&>", {200.0, 150.0}}, {"east", {400.0, 300.0}}};
    return roads;
}

inline std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

/// Without line ends, where wrapping may have put them.
inline std::string flat_text(const EquipmentFacts& facts) {
    return std::regex_replace(equipment_text(facts), std::regex("\n *"), " ");
}

inline std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

}  // namespace clearway::report
