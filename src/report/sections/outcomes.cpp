#include <fmt/format.h>

#include "report/lease_words.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::size_t shown_failures = 50;  // of each condition; the rest is counted

DataTable events_of(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "actions asked", "refused at some time", "ended by expiry", "collisions",
                     "with an EV", "teleports"},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        std::vector<std::string>& row = table.rows.emplace_back();
        row.push_back(condition.label());
        for (const char* const metric : event_metrics)
            row.push_back(grouped(condition.count(metric)));
    }
    return table;
}

DataTable leases_of(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "what its policy asked for"}, {}, DataTable::Cells::words};
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.condition.policies.empty())
            table.rows.push_back({condition.label(), lease_sentence(condition)});
    }
    return table;
}

DataTable endings_of(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "EVs", "arrived", "running at end", "teleported", "not inserted", "removed",
                     "others", "arrived", "runs", "failed", "missing"},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        const analysis::OutcomeCounts& ends = condition.emergency;
        table.rows.push_back({condition.label(), grouped(ends.total()), grouped(ends.arrived),
                              grouped(ends.running_at_end), grouped(ends.teleported),
                              grouped(ends.not_inserted), grouped(ends.removed),
                              grouped(condition.others.total()), grouped(condition.others.arrived),
                              grouped(condition.complete_runs), grouped(condition.failed.size()),
                              grouped(condition.missing_runs)});
    }
    return table;
}

void write_failures(const ScenarioFacts& scenario, Writer& writer) {
    bool any = false;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.failed.empty()) continue;
        any = true;
        DataTable table{{"Replication", "Cause"}, {}, DataTable::Cells::words};
        for (const FailedRun& run : condition.failed) {
            if (table.rows.size() == shown_failures) break;
            table.rows.push_back({std::to_string(run.replication), run.cause});
        }
        writer.markup(fmt::format("<details open><summary>{}, {}: {} failed</summary>\n",
                                  escaped(scenario.name), condition_label(condition),
                                  counted(condition.failed.size(), "run")));
        writer.table({fmt::format("failed-{}-{}", scenario.name, condition.title),
                      fmt::format("{}, {}: failed runs", scenario.name, condition.label()),
                      std::move(table)});
        if (condition.failed.size() > shown_failures)
            writer.markup(fmt::format("<p class=\"note\">The first {} are listed.</p>", shown_failures));
        writer.close_fold();
    }
    if (!any) writer.markup("<p class=\"note\">No run failed.</p>\n");
}

}  // namespace

void outcomes_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>How every vehicle of the demand ended, over all completed runs. Means over arrived EVs leave "
        "out all other EVs in this table. The second table counts the actions that policies asked for, "
        "how often one was refused at some time (each reason once; most are judged again, and may be carried "
        "out later), and what went wrong on the road; the third lists the actions and the reasons for "
        "refusals.</p>\n");
    for (const ScenarioFacts& scenario : study.scenarios) {
        writer.heading(scenario.name);
        writer.table(
            {"outcomes-" + scenario.name, scenario.name + ": how vehicles ended", endings_of(scenario)});
        writer.table({"events-" + scenario.name, scenario.name + ": actions and what went wrong",
                      events_of(scenario)});
        writer.table({"actions-" + scenario.name, scenario.name + ": actions by kind", leases_of(scenario)});
        write_failures(scenario, writer);
    }
}

}  // namespace clearway::report::detail
