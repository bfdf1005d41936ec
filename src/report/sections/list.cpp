#include <algorithm>
#include <array>

#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

using enum Section::Shown;

bool always(const StudyFacts& /*study*/) {
    return true;
}

bool any_scenario(const StudyFacts& study, bool (*holds)(const ScenarioFacts&)) {
    return std::any_of(study.scenarios.begin(), study.scenarios.end(), holds);
}

bool any_condition(const StudyFacts& study, bool (*holds)(const ConditionFacts&)) {
    return std::any_of(study.scenarios.begin(), study.scenarios.end(), [&](const ScenarioFacts& scenario) {
        return std::any_of(scenario.conditions.begin(), scenario.conditions.end(), holds);
    });
}

bool has_comparison(const StudyFacts& study) {
    return any_condition(study, [](const ConditionFacts& condition) { return condition.is_compared(); });
}

bool has_travel_times(const StudyFacts& study) {
    return any_condition(
        study, [](const ConditionFacts& condition) { return !condition.travel_time.points.empty(); });
}

bool has_approaches(const StudyFacts& study) {
    return any_condition(study,
                         [](const ConditionFacts& condition) { return !condition.approaches.empty(); });
}

bool has_safety(const StudyFacts& study) {
    return any_condition(study, [](const ConditionFacts& condition) { return !condition.safety.empty(); });
}

bool has_journeys(const StudyFacts& study) {
    return any_scenario(study, [](const ScenarioFacts& scenario) { return !scenario.journeys.empty(); });
}

bool has_counts(const StudyFacts& study) {
    return any_scenario(study, [](const ScenarioFacts& scenario) { return !scenario.flows.empty(); });
}

bool has_sensitivities(const StudyFacts& study) {
    return !study.sensitivities.empty();
}

bool has_pictures(const StudyFacts& study) {
    return any_scenario(study, [](const ScenarioFacts& scenario) { return !scenario.network_svg.empty(); });
}

bool has_curves(const StudyFacts& study) {
    return !study.curves.empty();
}

bool has_failure_curves(const StudyFacts& study) {
    return !study.failure_curves.empty();
}

bool has_plan(const StudyFacts& study) {
    return study.plan.has_value();
}

constexpr std::array<Section, 18> all_sections = {{
    {"overview", "At a glance", open, has_comparison, overview_section},
    {"plan", "What the plan set out to show", open, has_plan, plan_section},
    {"verdict", "Verdict", folded, always, verdict_section},
    {"sensitivity", "Sensitivity to each setting", folded, has_sensitivities, sensitivity_section},
    {"factors", "Factors", folded, has_factors, factors_section},
    {"tables", "Tables", folded, always, tables_section},
    {"differences", "Paired differences", folded, has_comparison, differences_section},
    {"travel-time", "Distribution of EV travel time", folded, has_travel_times, travel_time_section},
    {"failure", "Benefit against failure", folded, has_failure_curves, failure_section},
    {"cost", "Cost to the others", folded, has_approaches, cost_section},
    {"safety", "Safety, comfort and flow", folded, has_safety, safety_section},
    {"journeys", "An EV's journey", folded, has_journeys, journeys_section},
    {"enough", "Is n enough?", folded, has_comparison, enough_section},
    {"calibration", "Flows against counts", folded, has_counts, calibration_section},
    {"networks", "Networks", folded, has_pictures, networks_section},
    {"training", "Training of the nets", folded, has_curves, training_section},
    {"outcomes", "Outcomes and failed runs", folded, always, outcomes_section},
    {"reproduce", "How to reproduce", folded, always, reproduce_section},
}};

}  // namespace

std::span<const Section> sections() {
    return all_sections;
}

}  // namespace clearway::report::detail
