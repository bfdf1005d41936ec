#include "report/comparison.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "core/terminal.hpp"
#include "report/detail/json.hpp"
#include "report/facts.hpp"
#include "report/locks.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"
#include "results/factor_columns.hpp"

namespace clearway::report {
namespace {

using analysis::Comparison;
using analysis::ConditionSummary;
using analysis::ScenarioSummary;
using detail::Json;
using detail::json_of;

constexpr std::size_t comparison_label_width = 20;
constexpr std::size_t comparison_width = core::help_columns;
constexpr const char* numbers_format = "{:>7}{:>8}  {:<16}{:>5}{:>6}{:>7}{:>9}\n";

/// Calls `visit` with every condition that is compared, and its scenario.
template <class Visit>
void for_each_compared(const analysis::Summary& summary, Visit&& visit) {
    for (const ScenarioSummary& scenario : summary.scenarios) {
        for (const ConditionSummary& condition : scenario.conditions) {
            if (!condition.baseline.empty()) visit(scenario, condition);
        }
    }
}

bool is_unsafe(const ConditionSummary& condition) {
    return condition.condition.safety_checks == traffic::SafetyChecks::off;
}

const std::string& title_of(const ConditionTitleMap& titles, const ScenarioSummary& scenario,
                            const std::string& condition) {
    const auto title = titles.find({scenario.scenario, condition});
    return title == titles.end() ? condition : title->second;
}

std::string row_of(const std::string& label, const std::string& figures) {
    return table_row(label, comparison_label_width, figures);
}

std::string label_of(const ConditionTitleMap& titles, const ScenarioSummary& scenario,
                     const ConditionSummary& condition) {
    return printable(title_of(titles, scenario, condition.condition.name)) +
           (is_unsafe(condition) ? " (!)" : "");
}

/// Whether it is compared and has anything to show: what has not is told as not paired.
bool has_rows(const ConditionSummary& condition) {
    return std::ranges::any_of(condition.metrics, [](const analysis::MetricSummary& metric) {
        return metric.comparison && metric.comparison->complete_pairs > 0;
    });
}

/// As wide as its column: a d of 10 is as good as infinite.
std::string effect_size_words(const std::optional<double>& d) {
    return number_or_dash(d, {.decimals = std::abs(d.value_or(0.0)) < 9.995 ? 2 : 1});
}

std::string numbers_of(const Comparison& comparison) {
    const NumberStyle style{.decimals = 2};
    const NumberStyle with_sign{.decimals = 2, .sign = Sign::always};
    const auto& difference = comparison.difference;
    const bool few = comparison.complete_pairs < analysis::fewest_for_interval;
    const std::string interval = few && difference ? "too few seeds"
                                 : difference && difference->interval
                                     ? fmt::format("[{}, {}]", number(difference->interval->low, style),
                                                   number(difference->interval->high, style))
                                     : "(no interval)";
    const std::string pairs = comparison.incomplete_pairs == 0
                                  ? fmt::format("{}", comparison.complete_pairs)
                                  : fmt::format("{} of {}", comparison.complete_pairs,
                                                comparison.complete_pairs + comparison.incomplete_pairs);
    const auto& relative = comparison.relative;
    return fmt::format(fmt::runtime(numbers_format), pairs,
                       difference ? number(difference->mean, with_sign) : missing(Script::plain), interval,
                       relative ? number(100.0 * relative->mean, {.decimals = 0, .sign = Sign::always})
                                : missing(Script::plain),
                       few ? missing(Script::plain) : effect_size_words(comparison.effect_size),
                       few ? missing(Script::plain) : p_words(comparison.holm_p, Script::plain),
                       few ? missing(Script::plain) : p_words(comparison.wilcoxon_p, Script::plain));
}

Json to_json(const Comparison& comparison) {
    const auto& difference = comparison.difference;
    const auto& unlocked = comparison.unlocked;
    return {{"locked_pairs", comparison.locked_pairs},
            {"difference_without_locks", json_of(mean_of(unlocked))},
            {"interval_95_without_locks",
             shown_interval(unlocked) != nullptr ? json_of(unlocked->interval) : Json(nullptr)},
            {"complete_pairs", comparison.complete_pairs},
            {"incomplete_pairs", comparison.incomplete_pairs},
            {"vehicles_left_out", comparison.vehicles_left_out},
            {"difference", json_of(mean_of(difference))},
            {"interval_95",
             shown_interval(difference) != nullptr ? json_of(difference->interval) : Json(nullptr)},
            {"relative_1", json_of(mean_of(comparison.relative))},
            {"bca_95", json_of(comparison.bootstrap)},
            {"median", json_of(comparison.median)},
            {"median_95", json_of(comparison.median_interval)},
            {"effect_size_dz", json_of(comparison.effect_size)},
            {"t_p", json_of(comparison.t_p)},
            {"holm_p", json_of(comparison.holm_p)},
            {"wilcoxon_p", json_of(comparison.wilcoxon_p)}};
}

}  // namespace

bool more_is_better(const std::string& metric) {
    constexpr std::array better = {"emergency_arrived",
                                   "arrived",
                                   "links_true_positive",
                                   "dark_links_true_positive",
                                   "links_f1",
                                   "dark_links_f1",
                                   "signal_throughput_per_hour",
                                   "emergency_least_ttc_s",
                                   "signal_calls_granted"};
    return core::contains(better, metric);
}

namespace {

/// No tolerance of a mean outweighs a lost emergency vehicle.
void add_objections(const ScenarioSummary& scenario, const ConditionSummary& condition,
                    std::vector<Shortfall>& found) {
    const analysis::Objections& objections = condition.objections;
    for (const auto& [whose, why] : {std::pair<const char*, std::string>{
                                         "emergency vehicles", analysis::emergency_objections(objections)},
                                     {"other vehicles", analysis::other_objections(objections)}}) {
        if (!why.empty()) found.push_back({scenario.scenario, condition.condition.name, whose, why});
    }
}

/// Response times of the conditions that are compared; nothing where no EV arrived.
std::string response_text(const ScenarioSummary& scenario, const ConditionTitleMap& titles) {
    constexpr const char* format = "{:>8}  {:<19}  {:>8}  {}\n";
    std::string rows;
    double threshold_s = 0.0;
    for (const ConditionSummary& condition : scenario.conditions) {
        const analysis::ResponseTime& response = condition.response;
        if (!has_rows(condition) || response.threshold_s <= 0.0) continue;
        threshold_s = response.threshold_s;
        const auto cell = [](const MaybeEstimate& trips, double factor) {
            return trips ? number(factor * trips->mean, {}) : missing(Script::plain);
        };
        rows += row_of(label_of(titles, scenario, condition),
                       fmt::format(fmt::runtime(format), cell(response.percentile_90_s, 1.0),
                                   estimate(response.percentile_90_difference_s, {.sign = Sign::always}),
                                   cell(response.in_time, 100.0),
                                   estimate(response.in_time_difference, {.sign = Sign::always}, 100.0)));
    }
    if (rows.empty()) return rows;
    return fmt::format(
        "{}\n{}{:-<{}}\n{}\n",
        core::wrapped(fmt::format("{}: EV response time, 90th percentile, s, and trips within {:g} s, %",
                                  printable(scenario.scenario), threshold_s),
                      4),
        row_of("Condition",
               fmt::format(fmt::runtime(format), "90th pc.", "diff. [95 %]", "in time", "diff. [95 %]")),
        "", comparison_width, rows);
}

Json trips_json(const MaybeEstimate& trips) {
    if (!trips) return nullptr;
    return {{"value", trips->mean}, {"bca_95", json_of(trips->interval)}};
}

Json to_json(const analysis::ResponseTime& response) {
    const MaybeEstimate& difference = response.percentile_90_difference_s;
    return {{"threshold_s", response.threshold_s},
            {"percentile_90_s", trips_json(response.percentile_90_s)},
            {"percentile_90_difference_s", trips_json(difference)},
            {"in_time_1", trips_json(response.in_time)},
            {"in_time_difference_1", trips_json(response.in_time_difference)},
            {"complete_pairs", difference ? difference->n : 0}};
}

std::string unpaired_line(const analysis::Unpaired& lost) {
    std::string where = printable(lost.scenario);
    if (!lost.condition.empty()) where += "/" + printable(lost.condition);
    return core::wrapped(fmt::format("Not paired: {}{}{}", where, where.empty() ? "" : ": ", lost.why), 4) +
           "\n";
}

/// What differs between the folders and between their conditions of one name.
std::string differing_text(const analysis::Summary& summary) {
    std::string text;
    std::string builds;
    if (summary.builds)
        builds = core::wrapped(
                     fmt::format(
                         "Made by different builds of Clearway: {} in the first folder and {} in the second.",
                         printable(summary.builds->first), printable(summary.builds->second)),
                     4) +
                 "\n\n";
    for (const analysis::ConditionDifference& one : summary.differing)
        text += core::wrapped(fmt::format("{}: {} is {} in the first folder and {} in the second.",
                                          printable(one.condition), printable(one.setting),
                                          printable(one.first.value_or("as shipped")),
                                          printable(one.second.value_or("as shipped"))),
                              4) +
                "\n";
    return builds + (text.empty() ? text : "Conditions of the same name differ:\n" + text + "\n");
}

std::string adjusted_text(const analysis::Summary& summary, const ConditionTitleMap& titles) {
    std::string text;
    for (const analysis::AdjustedDifference& one : summary.adjusted) {
        const auto title = titles.find({one.scenario, one.condition});
        const std::string what =
            one.difference
                ? fmt::format(
                      "{} s of EV travel time, adjusted by {} runs of the baseline: as narrow as {} pairs "
                      "without.",
                      estimate(one.difference, {.decimals = 1, .sign = Sign::always}), one.baselines,
                      one.worth)
                : "not adjusted: EVs do not arrive in a run, pairs are few or nothing differs.";
        text +=
            core::wrapped(fmt::format("{}: {}: {}", printable(one.scenario),
                                      printable(title == titles.end() ? one.condition : title->second), what),
                          4) +
            "\n";
    }
    return text;
}

/// The lines before the tables.
std::string objections_text(const ScenarioSummary& scenario, const ConditionTitleMap& titles) {
    std::string text;
    for (const ConditionSummary& condition : scenario.conditions) {
        const auto add = [&](const std::string& words) {
            text += core::wrapped(
                        fmt::format("{}: {}: {}.", printable(scenario.scenario),
                                    printable(title_of(titles, scenario, condition.condition.name)), words),
                        4) +
                    "\n";
        };
        if (const std::string locks = lock_words(condition); !locks.empty()) add(locks);
        for (const std::string& why : {analysis::emergency_objections(condition.objections),
                                       analysis::other_objections(condition.objections)}) {
            if (!why.empty()) add(why);
        }
    }
    return text.empty() ? text : text + "\n";
}

}  // namespace

std::vector<Shortfall> shortfalls(const analysis::Summary& summary,
                                  const std::vector<Tolerance>& tolerances) {
    std::vector<Shortfall> found;
    if (!tolerances.empty()) {
        for (const analysis::Unpaired& lost : summary.unpaired)
            found.push_back({lost.scenario, lost.condition, "runs", lost.why});
    }
    for_each_compared(summary, [&](const ScenarioSummary& scenario, const ConditionSummary& condition) {
        if (!tolerances.empty()) add_objections(scenario, condition, found);
        for (const Tolerance& tolerance : tolerances) {
            const analysis::MetricSummary& metric = condition.metric(tolerance.metric);
            const auto& difference = metric.comparison->difference;
            std::string why;
            if (!difference || !difference->interval || difference->n < analysis::fewest_for_interval) {
                why = fmt::format("too few seeds: {} complete pairs, {} are needed",
                                  metric.comparison->complete_pairs, analysis::fewest_for_interval);
            } else {
                const bool inverted = more_is_better(tolerance.metric);
                const double worst = inverted ? -difference->interval->low : difference->interval->high;
                if (worst <= tolerance.largest) continue;
                why = fmt::format("its interval reaches to {}{}, {} is allowed",
                                  number(inverted ? -worst : worst, {.decimals = 2, .sign = Sign::always}),
                                  metric.metric.unit == "1" ? "" : " " + metric.metric.unit,
                                  inverted ? -tolerance.largest : tolerance.largest);
            }
            found.push_back({scenario.scenario, condition.condition.name, tolerance.metric, std::move(why)});
        }
    });
    return found;
}

std::string comparison_text(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                            const ConditionTitleMap& titles) {
    std::string text = differing_text(summary);
    auto out = std::back_inserter(text);
    bool any_unsafe = false;
    std::uint64_t fewest_pairs = fewest_to_trust;
    for (const ScenarioSummary& scenario : summary.scenarios) {
        text += objections_text(scenario, titles);
        std::string primary_rows;
        for (const std::string& name : metrics) {
            std::string rows;
            const analysis::MetricInfo* metric = nullptr;
            for (const ConditionSummary& condition : scenario.conditions) {
                if (!has_rows(condition)) continue;
                metric = &condition.metric(name).metric;
                any_unsafe = any_unsafe || is_unsafe(condition);
                const Comparison& comparison = *condition.metric(name).comparison;
                fewest_pairs = std::min<std::uint64_t>(fewest_pairs, comparison.complete_pairs);
                rows += row_of(label_of(titles, scenario, condition), numbers_of(comparison));
                if (const std::string words =
                        locked_pairs_words(comparison, usual_least_relevant_s, Script::plain);
                    !words.empty())
                    rows += core::wrapped("  " + words, 4) + "\n";
            }
            if (metric == nullptr) continue;
            const std::string title = fmt::format("{}: {}{}", printable(scenario.scenario), metric->doc,
                                                  metric->unit == "1" ? "" : ", " + metric->unit);
            if (name == "emergency_travel_time_s" && rows == primary_rows) {
                text += core::wrapped(title + ": the same as of all", 4) + "\n\n";
                continue;
            }
            if (name == analysis::primary_metric) primary_rows = rows;
            text += core::wrapped(title, 4) + "\n" +
                    row_of("Condition", fmt::format(fmt::runtime(numbers_format), "pairs", "diff.",
                                                    "95 % interval", "%", "d_z", "p Holm", "Wilcoxon"));
            fmt::format_to(out, "{:-<{}}\n{}\n", "", comparison_width, rows);
        }
        const auto is_travel_time = [](const std::string& name) { return name.ends_with("travel_time_s"); };
        if (std::ranges::any_of(metrics, is_travel_time)) text += response_text(scenario, titles);
    }
    text += adjusted_text(summary, titles);
    for (const analysis::Unpaired& lost : summary.unpaired)
        text += unpaired_line(lost);
    if (const std::string few = few_seeds_sentence(fewest_pairs); !few.empty()) text += few + '\n';
    if (any_unsafe) text += "(!): the simulator's safety checks were off in this condition.\n";
    return text;
}

std::string comparison_json(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                            const std::vector<Shortfall>& short_of, const ConditionTitleMap& titles) {
    Json comparisons = Json::array();
    const results::FactorColumns columns(summary.manifest);
    for_each_compared(summary, [&](const ScenarioSummary& scenario, const ConditionSummary& condition) {
        Json values = Json::object();
        for (const std::string& metric : metrics)
            values[metric] = to_json(*condition.metric(metric).comparison);
        const core::Settings factors = columns.settings(scenario.scenario, condition.condition.name);
        comparisons.push_back({{"scenario", scenario.scenario},
                               {"condition", condition.condition.name},
                               {"title", title_of(titles, scenario, condition.condition.name)},
                               {"compared_with", condition.baseline},
                               {"safety_checks", experiment::name(condition.condition.safety_checks)},
                               {"locks", detail::locks_json(condition)},
                               {"objections", analysis::emergency_objections(condition.objections)},
                               {"objections_of_others", analysis::other_objections(condition.objections)},
                               {"metrics", std::move(values)},
                               {"response", to_json(condition.response)}});
        if (!factors.empty()) comparisons.back()["factors"] = detail::factors_json(factors);
    });
    Json conditions = Json::array();
    for (const auto& [of, title] : titles)
        conditions.push_back({{"scenario", of.first}, {"condition", of.second}, {"title", title}});
    Json gates = Json::array();
    for (const Shortfall& one : short_of)
        gates.push_back({{"scenario", one.scenario},
                         {"condition", one.condition},
                         {"metric", one.metric},
                         {"why", one.why}});
    Json differing = Json::array();
    for (const analysis::ConditionDifference& one : summary.differing)
        differing.push_back({{"condition", one.condition},
                             {"setting", one.setting},
                             {"first", one.first ? Json(*one.first) : Json(nullptr)},
                             {"second", one.second ? Json(*one.second) : Json(nullptr)}});
    Json unpaired = Json::array();
    for (const analysis::Unpaired& lost : summary.unpaired)
        unpaired.push_back({{"scenario", lost.scenario}, {"condition", lost.condition}, {"why", lost.why}});
    Json result = {{"comparisons", std::move(comparisons)},
                   {"conditions", std::move(conditions)},
                   {"differing_settings", std::move(differing)},
                   {"unpaired", std::move(unpaired)},
                   {"short_of_tolerance", std::move(gates)}};
    for (const analysis::AdjustedDifference& one : summary.adjusted)
        result["adjusted"].push_back(
            {{"scenario", one.scenario},
             {"condition", one.condition},
             {"difference", json_of(mean_of(one.difference))},
             {"interval_95", one.difference ? json_of(one.difference->interval) : Json(nullptr)},
             {"baselines", one.baselines},
             {"worth_pairs", one.worth}});
    if (summary.builds)
        result["builds"] = {{"first", summary.builds->first}, {"second", summary.builds->second}};
    return detail::to_text(result);
}

}  // namespace clearway::report
