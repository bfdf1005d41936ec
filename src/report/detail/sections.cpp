#include "report/detail/sections.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "analysis/estimate.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/markup.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

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

constexpr std::array<Section, 16> all_sections = {{
    {"plan", "What the plan set out to show", has_plan, plan_section},
    {"verdict", "Verdict", always, verdict_section},
    {"sensitivity", "Sensitivity to each setting", has_sensitivities, sensitivity_section},
    {"tables", "Tables", always, tables_section},
    {"differences", "Paired differences", has_comparison, forest_section},
    {"travel-time", "Distribution of EV travel time", has_travel_times, distribution_section},
    {"failure", "Benefit against failure", has_failure_curves, failure_section},
    {"cost", "Cost to the others", has_approaches, cost_section},
    {"safety", "Safety, comfort and flow", has_safety, safety_section},
    {"journeys", "An EV's journey", has_journeys, journeys_section},
    {"enough", "Is n enough?", has_comparison, precision_section},
    {"calibration", "Flows against counts", has_counts, calibration_section},
    {"networks", "Networks", has_pictures, networks_section},
    {"training", "Training of the nets", has_curves, training_section},
    {"outcomes", "Outcomes and failed runs", always, outcomes_section},
    {"reproduce", "How to reproduce", always, reproduction_section},
}};

constexpr std::size_t shown_failures = 50;  // of each condition; the rest is counted

/// One figure per scenario, side by side if there is room.
std::string figures_of(const StudyFacts& study, std::string (*figure)(const ScenarioFacts&)) {
    std::string html;
    for (const ScenarioFacts& scenario : study.scenarios) {
        html += figure(scenario);
    }
    return html.empty() ? html : "<div class=\"figures\">\n" + html + "</div>\n";
}

const char* effect_class(Effect effect) {
    if (effect == Effect::better) return "effect better";
    if (effect == Effect::worse) return "effect worse";
    return "effect";
}

std::string verdict_entry(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const std::string sentence = verdict(scenario, condition, Script::typeset);
    const std::size_t colon = sentence.find(':');
    const Effect effect = condition.objections.on_emergency()
                              ? Effect::worse
                              : effect_of(condition, Measure::emergency_restricted_time);
    return fmt::format("<dt>{}</dt><dd><span class=\"{}\">{}</span>{}</dd>\n", condition_label(condition),
                       effect_class(effect), escaped(sentence.substr(0, colon)),
                       escaped(sentence.substr(colon)));
}

/// Verdicts of a scenario. Those of a setting turned alone are folded unless they say something else than the
/// condition at its defaults.
std::string verdict_card(const StudyFacts& study, const ScenarioFacts& scenario) {
    std::string entries;
    std::string folded;
    std::size_t count = 0;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        const ConditionFacts* const reference = reference_of(study, scenario, condition);
        const bool folds = reference != nullptr && !stands_out(condition, *reference);
        (folds ? folded : entries) += verdict_entry(scenario, condition);
        count += folds ? 1 : 0;
    }
    if (entries.empty() && folded.empty()) entries = "<dt>No condition was compared with a baseline.</dt>";
    if (!entries.empty()) entries = fmt::format("<dl>{}</dl>", entries);
    if (count > 0)
        entries += fmt::format(
            "<details class=\"fold\"><summary>{} with a setting turned alone, whose finding on EVs is the "
            "same</summary><dl>{}</dl></details>",
            counted(count, "condition"), folded);
    return fmt::format("<div class=\"card\"><h3>{}</h3><small>{}</small>{}</div>\n", escaped(scenario.name),
                       counted(scenario.replications, "replication"), entries);
}

DataTable events_of(const ScenarioFacts& scenario) {
    DataTable table{
        {"Condition", "actions asked", "refused", "ended by expiry", "collisions", "with an EV", "teleports"},
        {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        const Events& events = condition.events;
        table.rows.push_back({condition.label(), grouped(events.leases_issued),
                              grouped(events.leases_refused), grouped(events.leases_expired),
                              grouped(events.collisions), grouped(events.emergency_collisions),
                              grouped(events.teleports)});
    }
    return table;
}

std::string leases_of(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "what its policy asked for"}, {}, DataTable::Cells::words};
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.has_policy) table.rows.push_back({condition.label(), lease_sentence(condition)});
    }
    return table.rows.empty() ? std::string() : to_html(table);
}

std::string failures_of(const ScenarioFacts& scenario) {
    std::string html;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.failed.empty()) continue;
        DataTable table{{"Replication", "Cause"}, {}, DataTable::Cells::words};
        for (const FailedRun& run : condition.failed) {
            if (table.rows.size() == shown_failures) break;
            table.rows.push_back({std::to_string(run.replication), run.cause});
        }
        html +=
            fmt::format("<details open><summary>{}, {}: {} failed</summary>\n{}", escaped(scenario.name),
                        condition_label(condition), counted(condition.failed.size(), "run"), to_html(table));
        if (condition.failed.size() > shown_failures) {
            html += fmt::format("<p class=\"note\">The first {} are listed.</p>", shown_failures);
        }
        html += "</details>\n";
    }
    return html;
}

}  // namespace

std::span<const Section> sections() {
    return all_sections;
}

std::string verdict_section(const StudyFacts& study) {
    std::string html =
        "<p>Each condition against its baseline: what it did for emergency vehicles (EV) and to the "
        "others.</p>\n<div class=\"cards\">\n";
    for (const ScenarioFacts& scenario : study.scenarios) {
        html += verdict_card(study, scenario);
    }
    return html +
           "</div>\n"
           "<p class=\"note\">Differences are paired: condition and baseline share seed, demand, drivers "
           "and sensor failures. An effect is claimed only when the 95 % interval of the mean difference "
           "excludes 0; \u201cno effect shown\u201d does not prove that there is none. EV travel time is "
           "the restricted mean over all emergency vehicles (EV): one that did not arrive counts with the "
           "horizon. Whatever the means are, a condition is not called a help if it loses more EVs than its "
           "baseline, if its EVs collide more often, or if it ran without safety checks. Fewer than five "
           "replications give no interval and no effect: too few seeds.</p>\n";
}

std::string forest_section(const StudyFacts& study) {
    return "<p>Mean of the paired differences with its 95 % interval. Left of the line a condition takes "
           "less time than the baseline, right of it more. The gain of the EVs and the cost to the others "
           "share one axis.</p>\n" +
           figures_of(study, forest_figure);
}

std::string distribution_section(const StudyFacts& study) {
    return figures_of(study, distribution_figure) + "<h3>Pair by pair</h3>\n" +
           figures_of(study, slopes_figure);
}

std::string cost_section(const StudyFacts& study) {
    std::string costs;
    for (const ScenarioFacts& scenario : study.scenarios) {
        for (const ConditionFacts& condition : scenario.conditions)
            costs += approach_figure(scenario, condition);
    }
    const std::string recovery = figures_of(study, recovery_figure);
    return "<p>Who pays for the EVs\u2019 gain: time lost by all other vehicles on each approach to a "
           "signal (on each edge if a network has no signals), from a minute before the first EV, compared "
           "with the baseline of the same replication. With many approaches, one interval in twenty "
           "excludes 0 by chance.</p>\n"
           "<div class=\"figures\">\n" +
           costs + "</div>\n" + (recovery.empty() ? recovery : "<h3>Recovery after an EV</h3>\n" + recovery);
}

std::string journeys_section(const StudyFacts& study) {
    return "<p>The journey of one EV in one replication, under the baseline and the conditions that help "
           "most. The slope of the vehicle\u2019s line is its speed, and a level piece is a stop. One run "
           "shows how a policy works; for how much it gains see the tables.</p>\n" +
           figures_of(study, journey_figures);
}

std::string precision_section(const StudyFacts& study) {
    std::string html =
        "<p>Half the width of the 95 % interval of the EV travel time difference, as replications were "
        "added. Where the curve is below the line, differences as small as the line can be detected. If an "
        "effect is shown, n is enough; if none is, the last column gives the number of replications needed "
        "(FHWA: n = (t s / e)\u00b2, at least 10).</p>\n" +
        figures_of(study, precision_figure);
    for (const ScenarioFacts& scenario : study.scenarios)
        html += fmt::format("<h3>{}</h3>\n{}", escaped(scenario.name), to_html(precision_table(scenario)));
    return html;
}

std::string calibration_section(const StudyFacts& study) {
    std::string html =
        "<p>Flows of the baseline, without EVs and while demand departs, compared with flows counted on the "
        "road. GEH = \u221a(2 (m \u2212 c)\u00b2 / (m + c)) of hourly flows; below 5 a flow counts as "
        "matched, and the usual criterion requires this at 85 % of the places.</p>\n";
    for (const ScenarioFacts& scenario : study.scenarios) {
        if (scenario.flows.empty()) continue;
        DataTable table{{"Place", "counted, veh/h", "modelled, veh/h", "GEH"}, {}};
        std::size_t met = 0;
        for (const FlowFacts& flow : scenario.flows) {
            const auto cell = [](const std::optional<double>& value, int decimals) {
                return value ? number(*value, {decimals, Script::typeset}) : missing(Script::typeset);
            };
            if (flow.geh && *flow.geh < analysis::geh_limit) ++met;
            table.rows.push_back(
                {flow.street.empty() ? flow.edge : fmt::format("{} ({})", flow.street, flow.edge),
                 number(flow.counted_per_hour, {0, Script::typeset}), cell(flow.modelled_per_hour, 0),
                 cell(flow.geh, 1)});
        }
        html += fmt::format("<h3>{}</h3>\n<p>{} of {} places have a GEH below {}.</p>\n{}",
                            escaped(scenario.name), met, scenario.flows.size(), analysis::geh_limit,
                            to_html(table));
    }
    return html;
}

std::string networks_section(const StudyFacts& study) {
    return figures_of(study, network_figure);
}

std::string training_section(const StudyFacts& study) {
    std::string html =
        "<p>Train and test loss over the epochs (the dissertation\u2019s Fig. 4). Its text does not say "
        "whether the list of pairs holds only true links, so the network as published is trained both ways. "
        "A list of true links alone gives a low loss whatever the network learns: the constant answer 1 "
        "reaches it too.</p>\n"
        "<div class=\"figures\">\n";
    for (const LossCurve& curve : study.curves) {
        html += loss_figure(curve);
    }
    return html + "</div>\n";
}

std::string outcomes_section(const StudyFacts& study) {
    std::string html =
        "<p>How every vehicle of the demand ended, over all completed runs. Means over arrived EVs leave "
        "out all other EVs in this table. The second table counts the actions that policies asked for, "
        "those that were refused because they could not be carried out safely, and what went wrong on the "
        "road; the third lists the actions and the reasons for refusals.</p>\n";
    for (const ScenarioFacts& scenario : study.scenarios) {
        DataTable table{{"Condition", "EVs", "arrived", "running at end", "teleported", "not inserted",
                         "removed", "others", "arrived", "runs", "failed", "missing"},
                        {}};
        for (const ConditionFacts& condition : scenario.conditions) {
            const Endings& ends = condition.emergency;
            table.rows.push_back({condition.label(), grouped(ends.all()), grouped(ends.arrived),
                                  grouped(ends.running), grouped(ends.teleported), grouped(ends.not_inserted),
                                  grouped(ends.removed), grouped(condition.others.all()),
                                  grouped(condition.others.arrived), grouped(condition.runs),
                                  grouped(condition.failed.size()), grouped(condition.missing_runs)});
        }
        const std::string failures = failures_of(scenario);
        for (const ConditionFacts& condition : scenario.conditions) {
            if (condition.runs_without_horizon > 0)
                html += fmt::format("<p class=\"note\">{}: {}</p>\n", condition_label(condition),
                                    without_horizon_sentence(condition.runs_without_horizon));
        }
        html += fmt::format("<h3>{}</h3>\n{}{}{}", escaped(scenario.name), to_html(table),
                            to_html(events_of(scenario)) + leases_of(scenario),
                            failures.empty() ? "<p class=\"note\">No run failed.</p>\n" : failures);
    }
    return html;
}

std::string reproduction_section(const StudyFacts& study) {
    std::string html;
    if (!study.command.empty()) html += fmt::format("<pre><code>{}</code></pre>\n", escaped(study.command));
    html += "<dl class=\"facts\">\n";
    for (const auto& [name, value] : study.provenance) {
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
    }
    html += "</dl>\n<h3>Conditions</h3>\n<dl class=\"facts\">\n";
    if (!study.scenarios.empty()) {
        for (const ConditionFacts& condition : study.scenarios.front().conditions) {
            html += fmt::format("<dt>{} <code>{}</code></dt><dd>{}</dd>\n", condition_label(condition),
                                escaped(condition.name), escaped(condition.recipe));
        }
    }
    return html + "</dl>\n";
}

}  // namespace clearway::report::detail
