#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// A tile of the first screen: what was measured, the figure in large letters, what it means. Plain text.
struct Tile {
    const char* subject = "";
    std::string figure;
    std::string meaning;
    std::vector<std::string> details = {};  ///< What else is known of it, a line each.
    enum class Tone : std::uint8_t { neutral, better, worse } tone = Tone::neutral;
};
Tile emergency_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
/// Of the EVs that came to a closed road in the baseline, or that none did.
Tile incident_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
Tile others_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);
Tile safety_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// Whether a condition was run often enough to say what is said of its EV travel time.
struct Badge {
    enum class Runs : std::uint8_t { enough, too_few } runs = Runs::too_few;
    std::string words;  ///< Plain text.
};
Badge badge_of(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

}  // namespace clearway::report
