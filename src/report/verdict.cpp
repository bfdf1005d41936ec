#include "report/verdict.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clearway::report {
namespace {

/// `-12.3 s [-15.0, -9.6]`.
std::string difference_text(const ScenarioFacts& scenario, const ConditionFacts& condition, Measure measure,
                            Script script) {
    const NumberStyle style{decimals_of(scenario, measure), script, Sign::always};
    const Estimate& difference = condition.outcome(measure).difference;
    if (!difference.mean.has_value()) return missing(script);
    NumberStyle bounds = style;
    bounds.sign = Sign::negative_only;
    std::string text = fmt::format("{} {}", number(*difference.mean, style), info(measure).unit);
    if (difference.has_interval()) {
        text += fmt::format(" [{}, {}]", number(*difference.low, bounds), number(*difference.high, bounds));
    }
    return text;
}

/// ` (-18 %)` of the baseline's mean, or nothing where that mean is missing or 0.
std::string relative_text(const ScenarioFacts& scenario, const ConditionFacts& condition, Measure measure,
                          Script script) {
    const auto& difference = condition.outcome(measure).difference.mean;
    if (!condition.is_compared()) return {};
    const auto& base = scenario.conditions[*condition.baseline].outcome(measure).value.mean;
    if (!base || !difference || *base == 0.0) return {};
    return fmt::format(", {} %", number(100.0 * *difference / *base, {0, script, Sign::always}));
}

std::string lead(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const Outcome& outcome = condition.outcome(Measure::emergency_travel_time);
    const Estimate& difference = outcome.difference;
    const std::string amount = difference_text(scenario, condition, Measure::emergency_travel_time, script) +
                               relative_text(scenario, condition, Measure::emergency_travel_time, script);
    switch (effect_of(outcome, Better::lower)) {
        case Effect::better:
            return fmt::format("helped: EV travel time {}", amount);
        case Effect::worse:
            return fmt::format("harmed: EV travel time {}", amount);
        case Effect::negligible:
            return fmt::format("no relevant effect: EV travel time {}, where {} s would count", amount,
                               number(outcome.least_relevant, {1, script}));
        case Effect::none_shown:
            return fmt::format("no effect shown: EV travel time {}", amount);
        case Effect::undecided:
            break;
    }
    if (!difference.mean.has_value()) return "no verdict: no complete pair of runs";
    return fmt::format("no verdict: one pair of runs has no interval (EV travel time {})", amount);
}

/// What else changed beyond doubt; for the others also that nothing is shown.
std::string costs(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    std::string text;
    const auto add = [&](Measure measure, const char* better, const char* worse, const char* none) {
        const Effect effect = effect_of(condition.outcome(measure), info(measure).better);
        if (effect == Effect::undecided) return;
        const char* const words = effect == Effect::better ? better : effect == Effect::worse ? worse : none;
        if (*words == '\0') return;
        text += fmt::format("; {} ({})", words, difference_text(scenario, condition, measure, script));
    };
    add(Measure::other_time_loss, "the others lose less time", "the others lose more time",
        "no effect shown on the others' time loss");
    add(Measure::collisions, "fewer collisions", "more collisions", "");
    add(Measure::teleports, "fewer teleports", "more teleports", "");
    add(Measure::unfinished, "fewer unfinished vehicles", "more unfinished vehicles", "");
    return text;
}

}  // namespace

Effect effect_of(const Outcome& outcome, Better better) {
    const Estimate& difference = outcome.difference;
    if (!difference.has_interval()) return Effect::undecided;
    const bool excludes_zero = *difference.high < 0.0 || *difference.low > 0.0;
    const double least = outcome.least_relevant;
    const bool within = -least < *difference.low && *difference.high < least;
    if (within || (excludes_zero && std::abs(*difference.mean) < least)) return Effect::negligible;
    if (!excludes_zero) return Effect::none_shown;
    return (*difference.high < 0.0) == (better == Better::lower) ? Effect::better : Effect::worse;
}

std::string verdict(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    std::string text = lead(scenario, condition, script);
    if (condition.outcome(Measure::emergency_travel_time).difference.has_interval()) {
        text += costs(scenario, condition, script);
    }
    text += ".";
    if (condition.safety_checks_off)
        text += " Safety checks of the simulator were off: vehicles may drive through each other.";
    return text;
}

std::string headline(const StudyFacts& study) {
    std::vector<std::string> parts;
    for (const ScenarioFacts& scenario : study.scenarios) {
        std::size_t compared = 0;
        std::array<std::size_t, 5> seen = {};
        for (const ConditionFacts& condition : scenario.conditions) {
            if (!condition.is_compared()) continue;
            ++compared;
            const Outcome& outcome = condition.outcome(Measure::emergency_travel_time);
            ++seen[static_cast<std::size_t>(effect_of(outcome, Better::lower))];
        }
        if (compared == 0) continue;
        constexpr std::array<const char*, 5> words = {"EVs faster", "slower", "no relevant effect",
                                                      "no effect shown", "no verdict"};
        std::vector<std::string> findings;
        for (std::size_t effect = 0; effect < seen.size(); ++effect) {
            if (seen[effect] == 0) continue;
            const std::string total =
                findings.empty() ? fmt::format(" of {}", counted(compared, "condition")) : "";
            findings.push_back(fmt::format("{} under {}{}", words[effect], seen[effect], total));
        }
        parts.push_back(fmt::format("{}: {}", scenario.name, fmt::join(findings, ", ")));
    }
    if (parts.empty()) return "No condition was compared with a baseline.";
    return fmt::format("{}.", fmt::join(parts, "; "));
}

}  // namespace clearway::report
