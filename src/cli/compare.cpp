#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary.hpp"
#include "campaign/names.hpp"
#include "campaign/publication.hpp"
#include "campaign/stored_folder.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "core/terminal.hpp"
#include "report/comparison.hpp"
#include "report/read_facts.hpp"
#include "report/shared_sentences.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"
#include "results/store.hpp"

namespace clearway::cli {
namespace {

struct CompareArguments {
    std::string first;
    std::string second;
    std::string against;               ///< Empty: the baselines.
    std::string baselines;             ///< Run folder; empty: none.
    std::vector<std::string> metrics;  ///< Empty: `usual_metrics`.
    std::vector<std::string> tolerances;
    std::optional<double> response_threshold_s;
    campaign::Publication publication;
    Printing printing = Printing::text;
};

const std::vector<std::string>& usual_metrics() {
    static const std::vector<std::string> names = {analysis::primary_metric, "emergency_travel_time_s",
                                                   "others_time_loss_s", "collisions", "teleports"};
    return names;
}

std::vector<std::string> metric_names() {
    return core::texts_of(analysis::all_metrics(), &analysis::MetricInfo::name);
}

/// The metric of a tolerance without a name: the chosen one, else the primary one.
std::string gated_metric(const std::vector<std::string>& chosen, const std::string& word) {
    if (chosen.size() > 1)
        throw core::InputError({"--tolerance", fmt::format("`{}` names none of the chosen metrics", word),
                                core::listed(chosen),
                                fmt::format("Say which: --tolerance {}={}", chosen[0], word)});
    return chosen.empty() ? analysis::primary_metric : chosen[0];
}

/// Reads `1.5`, for the chosen metric, or `METRIC=1.5`.
report::Tolerance tolerance_from(const std::string& word, const std::vector<std::string>& chosen) {
    const std::size_t equals = word.find('=');
    report::Tolerance tolerance;

    if (equals != std::string::npos) tolerance.metric = word.substr(0, equals);
    const std::string value = equals == std::string::npos ? word : word.substr(equals + 1);
    char* end = nullptr;
    tolerance.largest = std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0' || !std::isfinite(tolerance.largest) || tolerance.largest < 0.0)
        throw core::InputError({"--tolerance", fmt::format("`{}` is not a tolerance", word),
                                "a number of at least 0, in the metric's unit, or METRIC=NUMBER", ""});
    if (equals == std::string::npos) tolerance.metric = gated_metric(chosen, word);
    return tolerance;
}

/// All tolerances. Their metrics are added to those that are shown.
std::vector<report::Tolerance> check(CompareArguments& arguments) {
    std::vector<report::Tolerance> tolerances;
    const std::vector<std::string> chosen = arguments.metrics;
    if (chosen.empty()) arguments.metrics = usual_metrics();
    for (const std::string& word : arguments.tolerances) {
        tolerances.push_back(tolerance_from(word, chosen));
        const std::string& metric = tolerances.back().metric;
        if (!core::contains(arguments.metrics, metric)) arguments.metrics.push_back(metric);
    }
    const std::vector<std::string> known = metric_names();
    std::vector<core::Problem> problems;
    for (const std::string& metric : arguments.metrics) {
        if (!core::contains(known, metric))
            problems.push_back(campaign::unknown_name("metric", metric, known, "clearway list columns"));
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return tolerances;
}

analysis::Reference reference_of(const CompareArguments& arguments, const results::Manifest& manifest) {
    if (!arguments.against.empty() && !arguments.second.empty())
        throw core::InputError(
            {"--against", "is for one run folder, and there are two", "", "Leave out " + arguments.second});
    return campaign::reference_from(arguments.against, manifest.conditions, arguments.first);
}

/// `reference` is set to what conditions are compared with.
analysis::Summary summary_of(const CompareArguments& arguments, analysis::Reference& reference) {
    for (const std::string& folder : {arguments.first, arguments.second})
        if (!folder.empty()) campaign::renew_edited_tables(results::Store::open(folder));
    const results::Results first =
        results::read_results(results::Store::open(arguments.first), results::VehicleRows::emergency);
    reference = reference_of(arguments, first.manifest);
    if (!arguments.second.empty())
        return analysis::compare_studies(
            first,
            results::read_results(results::Store::open(arguments.second), results::VehicleRows::emergency),
            analysis::usual_level, arguments.response_threshold_s);
    analysis::Summary summary =
        analysis::summarise(first, analysis::usual_level, arguments.response_threshold_s, reference);
    const bool compared = std::ranges::any_of(summary.scenarios, [](const auto& scenario) {
        return std::ranges::any_of(scenario.conditions,
                                   [](const auto& condition) { return !condition.baseline.empty(); });
    });
    const bool only_tells = arguments.printing == Printing::json && arguments.tolerances.empty();
    if (!compared && !only_tells && arguments.publication.file.empty())
        throw core::InputError({arguments.first,
                                arguments.against.empty() ? "has no condition besides its baselines"
                                : reference.is_best()
                                    ? "has no two conditions that act under the same failure"
                                    : "has no other condition in the environment of " + arguments.against,
                                "", "Name a second run folder to compare it with"});
    return summary;
}

const char* standing(report::Effect effect) {
    switch (effect) {
        case report::Effect::better:
            return "is ahead of";
        case report::Effect::worse:
            return "is behind";
        case report::Effect::negligible:
            return "is level with";
        case report::Effect::none_shown:
            return "is not shown to differ from";
        case report::Effect::too_few:
        case report::Effect::ruled_out:
        case report::Effect::undecided:
            break;
    }
    return "cannot be told yet from";
}

/// How a condition stands to another in a metric, with what speaks against believing it.
std::string standing_text(const analysis::MetricSummary& metric, const std::string& condition,
                          const std::string& other) {
    const analysis::Comparison& comparison = *metric.comparison;
    const bool more = report::more_is_better(metric.metric.name);
    const bool is_time = metric.metric.unit == "s";
    const report::Effect effect =
        report::effect_of(comparison.difference, more ? report::Better::higher : report::Better::lower,
                          is_time ? report::usual_least_relevant_s : 0.0);
    const std::string difference =
        report::estimate(comparison.difference, {.decimals = 1, .sign = report::Sign::always});
    const bool is_primary = metric.metric.name == analysis::primary_metric;
    const std::string unit = metric.metric.unit == "1" ? "" : " " + metric.metric.unit;
    const std::string what = is_primary ? fmt::format(": {} s of EV travel time", difference)
                                        : fmt::format(" by EV travel time: {}{}", difference, unit);
    return fmt::format("{}{} {} {}, the best other one{}{}.",
                       is_primary ? "" : fmt::format("in {}, ", metric.metric.name), condition,
                       standing(effect), other, what,
                       report::doubt_clause(report::doubts_of(effect, comparison, report::Script::plain)));
}

/// Which conditions were the best, and what choosing them so means.
std::string best_text(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                      const report::ConditionTitleMap& titles) {
    const bool has_primary = core::contains(metrics, analysis::primary_metric);
    const std::string metric = has_primary ? analysis::primary_metric : metrics.front();
    std::string text;
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        const auto title = [&](const std::string& name) {
            return report::printable(titles.at({scenario.scenario, name}));
        };
        for (const analysis::ConditionSummary& condition : scenario.conditions) {
            if (condition.baseline.empty()) continue;
            text += core::wrapped(report::printable(scenario.scenario) + ": " +
                                      standing_text(condition.metric(metric), title(condition.condition.name),
                                                    title(condition.baseline)),
                                  4) +
                    "\n";
        }
    }
    return text +
           core::wrapped(
               "Each is compared with the best other condition of the same failure and factors: the "
               "least mean EV travel time, all, without lost or hit EVs. It was chosen by the same runs, "
               "which favours it: the smallest of several means is usually a little too small. Repeat the "
               "comparison with --against NAME on other seeds.",
               0) +
           "\n";
}

core::ExitCode compare(CompareArguments arguments) {
    if (!arguments.publication.file.empty() && !arguments.second.empty())
        throw core::InputError({"--publish", "writes the rows of one run folder, and there are two", "",
                                "Leave out " + arguments.second});
    if (!arguments.publication.file.empty() && !arguments.against.empty())
        throw core::InputError({"--publish", "writes differences from baselines, and there is --against", "",
                                "Leave out one of them"});
    if (const std::string& other = arguments.second.empty() ? arguments.against : arguments.second;
        !arguments.baselines.empty() && !other.empty())
        throw core::InputError({"--baselines",
                                "adjusts differences from the baselines of one folder, and there is " + other,
                                "", "Leave out " + other});
    const std::vector<report::Tolerance> tolerances = check(arguments);
    analysis::Reference reference;
    analysis::Summary summary = summary_of(arguments, reference);
    if (!arguments.baselines.empty())
        analysis::adjust_by(
            results::read_results(results::Store::open(arguments.baselines), results::VehicleRows::emergency),
            summary);
    const report::Titles titles =
        report::titles_of(results::Store::open(arguments.first), summary, reference);
    const std::vector<report::Shortfall> found = report::shortfalls(summary, tolerances);
    if (arguments.printing == Printing::json) {
        fmt::print("{}", report::comparison_json(summary, arguments.metrics, found, titles.conditions));
    } else {
        fmt::print("{}", report::comparison_text(summary, arguments.metrics, titles.conditions));
        if (!arguments.second.empty())
            fmt::print("diff.: {} minus {}, paired by scenario, condition and replication.\n",
                       arguments.second, arguments.first);
        if (reference.is_best())
            fmt::print("{}", best_text(summary, arguments.metrics, titles.conditions));
        else if (!arguments.against.empty())
            fmt::print("diff.: minus {}, paired by scenario and replication.\n",
                       report::printable(titles.reference));
    }
    if (!arguments.publication.file.empty())
        campaign::publish_study(arguments.publication, results::Store::open(arguments.first), summary,
                                arguments.metrics);
    for (const report::Shortfall& one : found)
        fmt::print(stderr, "clearway: {}{}{}: {}: {}\n", one.scenario, one.condition.empty() ? "" : "/",
                   one.condition, one.metric, one.why);
    return found.empty() ? core::ExitCode::ok : core::ExitCode::fell_short;
}

}  // namespace

Action configure_compare(App& app) {
    const auto arguments = std::make_shared<CompareArguments>();
    app.add_option("run", arguments->first, "Run folder; its conditions are compared with their baseline")
        .required()
        .option_text("DIR (required)");
    app.add_option("other", arguments->second,
                   "Second run folder: its runs are compared with the same runs of the first")
        .option_text("DIR [none]");
    app.add_option(
           "--against", arguments->against,
           "Condition of the run folder that the others are compared with; or levels of factors: each "
           "is compared with the one that is the same but for these; or best: with the best other one")
        .option_text("NAME|FACTOR=LEVEL,...|best [the baselines]");
    app.add_option(
           "--baselines", arguments->baselines,
           "Run folder of clearway study --baselines, by which differences in EV travel time are adjusted")
        .option_text("DIR [none]");
    app.add_option("--metric", arguments->metrics, "Metric to compare, a column of runs.csv; may be repeated")
        .allow_extra_args(false)
        .option_text("NAME [EV and others' times, collisions, teleports]");
    app.add_option("--tolerance", arguments->tolerances,
                   "Exit with 6 if it may be worse by more than this (95 %), or if more EVs are lost")
        .allow_extra_args(false)
        .option_text("[METRIC=]NUMBER ... [none]");
    add_response_option(app, arguments->response_threshold_s);
    add_publish_options(app, arguments->publication);
    add_json_option(app, arguments->printing, "the comparison");
    return [arguments](const Invocation&) { return compare(*arguments); };
}

}  // namespace clearway::cli
