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
    return std::ranges::any_of(study.scenarios, holds);
}

bool any_condition(const StudyFacts& study, bool (*holds)(const ConditionFacts&)) {
    return std::ranges::any_of(study.scenarios, [&](const ScenarioFacts& scenario) {
        return std::ranges::any_of(scenario.conditions, holds);
    });
}

bool has_comparison(const StudyFacts& study) {
    return any_condition(study, [](const ConditionFacts& one) { return one.is_compared(); });
}

bool has_travel_times(const StudyFacts& study) {
    return any_condition(study, [](const ConditionFacts& one) { return !one.distribution.points.empty(); });
}

bool has_approaches(const StudyFacts& study) {
    return any_condition(study, [](const ConditionFacts& one) { return !one.approaches.empty(); });
}

bool has_runs(const StudyFacts& study) {
    return any_condition(study, [](const ConditionFacts& one) { return one.complete_runs > 0; });
}

bool has_journeys(const StudyFacts& study) {
    return any_scenario(study, [](const ScenarioFacts& one) { return !one.journeys.empty(); });
}

bool has_counts(const StudyFacts& study) {
    return any_scenario(study, [](const ScenarioFacts& one) { return !one.flows.empty(); });
}

bool has_pictures(const StudyFacts& study) {
    return any_scenario(study, [](const ScenarioFacts& one) { return !one.network_svg.empty(); });
}

template <auto member>
bool has(const StudyFacts& study) {
    return std::ranges::size(study.*member) > 0;
}

bool has_plan(const StudyFacts& study) {
    return study.plan.has_value();
}

constexpr std::array<Section, 18> all_sections = {{
    {"plan", "What the plan set out to show", open, has_plan, plan_section},
    {"overview", "At a glance", open, has_comparison, overview_section},
    {"verdict", "Verdict", folded, always, verdict_section},
    {"sensitivity", "Sensitivity to each setting", folded, has<&StudyFacts::sensitivities>,
     sensitivity_section},
    {"factors", "Factors", folded, has_factors, factors_section},
    {"tables", "Tables", folded, always, tables_section},
    {"differences", "Paired differences", folded, has_comparison, differences_section},
    {"travel-time", "Distribution of EV travel time", folded, has_travel_times, travel_time_section},
    {"failure", "Benefit against failure", folded, has<&StudyFacts::failure_curves>, failure_section},
    {"cost", "Cost to the others", folded, has_approaches, cost_section},
    {"safety", "Safety, comfort and flow", folded, has_runs, safety_section},
    {"journeys", "An EV's journey", folded, has_journeys, journeys_section},
    {"enough", "Is n enough?", folded, has_comparison, enough_section},
    {"calibration", "Flows against counts", folded, has_counts, calibration_section},
    {"networks", "Networks", folded, has_pictures, networks_section},
    {"training", "Training of the nets", folded, has<&StudyFacts::curves>, training_section},
    {"outcomes", "Outcomes and failed runs", folded, always, outcomes_section},
    {"reproduce", "How to reproduce", folded, always, reproduce_section},
}};

}  // namespace

std::span<const Section> sections() {
    return all_sections;
}

}  // namespace clearway::report::detail
