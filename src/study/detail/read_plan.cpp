#include "study/detail/read_plan.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "metrics/run_metrics.hpp"

namespace clearway::study::detail {
namespace {

using core::StrictTable;

template <class Element>
std::vector<std::string> names_of(const std::vector<Element>& elements) {
    std::vector<std::string> names;
    for (const Element& element : elements)
        names.push_back(element.name);
    return names;
}

void check_name(StrictTable& row, const char* key, const std::string& name,
                const std::vector<std::string>& known) {
    if (std::ranges::find(known, name) != known.end()) return;
    const std::string near = core::nearest(name, known);
    row.problem(key, name.empty() ? "is missing" : fmt::format("'{}' is not in the study", name),
                fmt::format("{}", fmt::join(known, ", ")),
                near.empty() ? "" : fmt::format("Did you mean '{}'?", near));
}

/// Metrics in seconds, for which the margin has a meaning.
std::vector<std::string> metrics_in_seconds() {
    std::vector<std::string> names;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) {
        if (std::string_view(field.unit) == "s") names.emplace_back(field.name);
    });
    return names;
}

results::PlannedComparison read_comparison(StrictTable& row) {
    results::PlannedComparison comparison;
    row.text("name", comparison.name);
    row.text("scenario", comparison.scenario);
    row.text("condition", comparison.condition);
    row.text("against", comparison.against);
    row.word<results::Claim>("claim", comparison.claim);
    row.finish();
    return comparison;
}

void check_comparison(StrictTable& row, const results::PlannedComparison& comparison,
                      const StudyConfig& config, std::set<std::string>& names) {
    if (comparison.name.empty()) row.problem("name", "is missing", "a name", "Name the comparison");
    if (!comparison.name.empty() && !names.insert(comparison.name).second)
        row.problem("name", fmt::format("'{}' occurs twice", comparison.name), "a name of its own", "");
    check_name(row, "condition", comparison.condition, names_of(config.conditions));
    check_name(row, "against", comparison.against, names_of(config.conditions));
    if (!comparison.condition.empty() && comparison.condition == comparison.against)
        row.problem("against", "is the condition itself", "another condition", "");
    if (!comparison.scenario.empty())
        check_name(row, "scenario", comparison.scenario, names_of(config.scenarios));
}

/// The margin is a share of the delay, and the delay needs the time of an emergency vehicle alone.
void check_margin(StrictTable& reader, const results::AnalysisPlan& plan, const StudyConfig& config) {
    const bool has_solo = std::ranges::any_of(config.conditions, [](const experiment::ConditionSpec& one) {
        return one.traffic_model == experiment::TrafficModel::free_flow;
    });
    const bool needs_it = plan.margin_share > 0.0 &&
                          std::ranges::any_of(plan.comparisons, [](const results::PlannedComparison& one) {
                              return one.claim == results::Claim::equivalence;
                          });
    if (needs_it && !has_solo)
        reader.problem("margin_share", "is a share of the delay, which needs the condition solo",
                       "0, or a study with solo", "Add solo to the conditions");
}

}  // namespace

void read_plan(StrictTable& root, Extent extent, StudyConfig& config) {
    auto reader = root.below("plan");
    if (!reader) return;
    results::AnalysisPlan plan;
    reader->text("metric", plan.metric);
    reader->read(plan);
    std::vector<StrictTable> rows = reader->rows("comparison");
    for (StrictTable& row : rows)
        plan.comparisons.push_back(read_comparison(row));
    reader->finish();
    const std::vector<std::string> metrics = metrics_in_seconds();
    if (std::ranges::find(metrics, plan.metric) == metrics.end())
        reader->problem("metric", fmt::format("'{}' is not a metric in seconds", plan.metric),
                        fmt::format("{}", fmt::join(metrics, ", ")), "");
    if (rows.empty())
        reader->problem("comparison", "is missing", "at least one [[plan.comparison]]",
                        "Name what the study is to show, or remove [plan]");
    if (config.precision)
        root.problem("precision", "is given together with [plan]",
                     "replications: looking at results until they suffice finds too much",
                     "Fix the number of replications beforehand");
    if (extent == Extent::quick) return;
    std::set<std::string> names;
    for (std::size_t at = 0; at < rows.size(); ++at)
        check_comparison(rows[at], plan.comparisons[at], config, names);
    check_margin(*reader, plan, config);
    config.plan = std::move(plan);
}

}  // namespace clearway::study::detail
