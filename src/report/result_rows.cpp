#include "report/result_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::ConditionSummary;
using analysis::ScenarioSummary;

bool is_ratio(const std::string& unit) {
    return unit == "1";
}

/// One decimal; two or three for ratios and counts, where most values are small.
int decimals_for(const std::string& unit, double largest) {
    if (!is_ratio(unit)) return 1;
    return largest <= 1.0 ? 3 : 2;
}

/// Whether an interval that excludes 0 does so no longer once its ends are rounded.
bool rounds_to_zero(const analysis::Interval& interval, double factor, int decimals) {
    if (interval.low <= 0.0 && interval.high >= 0.0) return false;
    const double nearest_end = std::min(std::abs(interval.low), std::abs(interval.high)) * factor;
    return nearest_end < 0.5 * std::pow(10.0, -decimals);
}

/// Fills the figures of a row.
void put(ResultRow& row, const std::string& unit, double mean, const analysis::Interval* interval,
         double factor = 1.0) {
    double largest = std::abs(mean * factor);
    if (interval != nullptr)
        largest = std::max({largest, std::abs(interval->low * factor), std::abs(interval->high * factor)});
    NumberStyle style{.decimals = decimals_for(unit, largest)};
    if (interval != nullptr && rounds_to_zero(*interval, factor, style.decimals)) ++style.decimals;
    row.unit = is_ratio(unit) ? "" : unit;
    row.mean = number(mean * factor, style);
    row.low = interval != nullptr ? number(interval->low * factor, style) : "";
    row.high = interval != nullptr ? number(interval->high * factor, style) : "";
}

void append(const MaybeEstimate& estimate, const std::string& unit, ResultRow row,
            std::vector<ResultRow>& rows, double factor = 1.0) {
    if (!estimate || !std::isfinite(estimate->mean)) return;
    row.pairs = std::to_string(estimate->n);
    put(row, unit, estimate->mean, shown_interval(estimate), factor);
    rows.push_back(std::move(row));
}

/// Whether lost emergency vehicles are missing from a mean.
bool hides_lost(const ConditionSummary& condition, const analysis::MetricInfo& metric) {
    return condition.objections.loses_emergency() && metric.name.starts_with("emergency_") &&
           metric.kind == analysis::MetricKind::quantity && metric.name != analysis::primary_metric;
}

ResultRow row_of(const RowSource& source) {
    ResultRow row;
    row.tree = source.tree;
    row.date = source.date;
    row.command = source.command;
    row.behaviour = source.behaviour;
    row.origin = "product";
    return row;
}

/// What a few runs cannot decide: median of the pairs and mean of those without a lock; and the replications
/// that the interval of the mean needs for a half width of 1.
void append_robust(const analysis::Comparison& comparison, const std::string& unit, ResultRow row,
                   std::vector<ResultRow>& rows) {
    const std::string name = analysis::primary_metric;
    row.measure = name + ":unlocked";
    append(comparison.unlocked, unit, row, rows);
    row.pairs = std::to_string(comparison.complete_pairs);
    if (comparison.median) {
        row.measure = name + ":median";
        const analysis::Interval* const interval = shown_interval(comparison.difference);
        put(row, unit, *comparison.median,
            interval && comparison.median_interval ? &*comparison.median_interval : nullptr);
        rows.push_back(row);
    }
    if (!comparison.difference || comparison.difference->n < 2) return;
    row.measure = name + ":replications";
    row.unit = "runs";
    row.mean = std::to_string(analysis::advised_replications(comparison.difference->deviation, 1.0));
    row.low = row.high = "";
    rows.push_back(row);
}

void append_metric(const ConditionSummary& condition, const std::string& name, ResultRow row,
                   std::vector<ResultRow>& rows) {
    const analysis::MetricSummary& metric = condition.metric(name);
    if (hides_lost(condition, metric.metric)) return;
    row.measure = name;
    append(metric.estimate, metric.metric.unit, row, rows);
    if (!metric.comparison) return;
    row.measure = name + ":difference";
    append(metric.comparison->difference, metric.metric.unit, row, rows);
    row.measure = name + ":percent";
    append(metric.comparison->relative, "%", row, rows, 100.0);
    if (name == analysis::primary_metric) append_robust(*metric.comparison, metric.metric.unit, row, rows);
}

using Key = std::tuple<std::string, std::string, std::string, std::string>;

Key key_of(const ResultRow& row) {
    return {row.study, row.scenario, row.condition, row.measure};
}

std::string header() {
    std::string line;
    core::append_header<ResultRow>(line);
    return line.substr(1) + "\n";
}

std::string line_of(const ResultRow& row) {
    std::string line;
    core::append_cells(line, row);
    return line.substr(1) + "\n";
}

std::vector<ResultRow> rows_in(std::string_view text, const std::string& name) {
    std::vector<ResultRow> rows;
    if (text.empty()) return rows;
    const auto refuse = [&](const std::string& what) {
        return core::InputError({name, what, header().substr(0, header().size() - 1),
                                 "Name a file of results/, or one that does not exist yet"});
    };
    if (!text.starts_with(header())) throw refuse("has another header");
    try {
        core::CsvReader reader(text);
        reader.next();
        while (reader.next()) {
            ResultRow& row = rows.emplace_back();
            std::size_t at = 0;
            core::for_each_field<ResultRow>([&](const auto& field) {
                if (at < reader.cells().size()) core::read_cell(reader.cells()[at], row.*field.member);
                ++at;
            });
            if (reader.cells().size() != at)
                throw refuse(fmt::format("row {} has {} fields and not {}", rows.size() + 1,
                                         reader.cells().size(), at));
        }
    } catch (const std::runtime_error& error) {
        if (dynamic_cast<const core::Error*>(&error) != nullptr) throw;
        throw refuse(error.what());
    }
    return rows;
}

}  // namespace

std::vector<ResultRow> study_rows(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                                  const RowSource& source) {
    std::vector<ResultRow> rows;
    ResultRow row = row_of(source);
    row.study = summary.manifest.study;
    row.seed = std::to_string(summary.manifest.study_seed);
    for (const ScenarioSummary& scenario : summary.scenarios) {
        row.scenario = scenario.scenario;
        for (const ConditionSummary& condition : scenario.conditions) {
            row.condition = condition.condition.name;
            const analysis::OutcomeCounts& vehicles = condition.emergency;
            row.lost_evs =
                vehicles.total() > 0 ? fmt::format("{} of {}", vehicles.lost(), vehicles.total()) : "";
            for (const std::string& metric : metrics)
                append_metric(condition, metric, row, rows);
            row.measure = "gap_closed";
            if (!condition.objections.loses_emergency()) append(condition.gap_closed, "%", row, rows, 100.0);
        }
    }
    return rows;
}

std::vector<ResultRow> link_rows(const LinkFacts& facts, const RowSource& source) {
    std::vector<ResultRow> rows;
    ResultRow row = row_of(source);
    row.study = facts.title;
    row.seed = std::to_string(facts.study_seed);
    // There is nothing to pool for a single scenario.
    const bool pooled = facts.scenarios.size() > 1;
    for (const links::LinkResult& result : facts.results) {
        if (pooled && !result.scenario.empty()) continue;
        row.scenario = facts.title + ", " + result.failure;
        if (result.exits == links::Exits::unknown) row.scenario += ", exits unknown";
        row.condition = result.predictor;
        row.pairs = std::to_string(facts.runs);
        const links::LinkMeasures& all = result.of(links::LinkSubset::all);
        const auto add = [&](const char* measure, const char* unit, const analysis::Measured& measured) {
            if (!measured.value) return;
            row.measure = measure;
            put(row, unit, *measured.value, measured.interval ? &*measured.interval : nullptr);
            rows.push_back(row);
        };
        add("ap", "1", all.ap);
        add("auc", "1", all.auc);
        add("f1", "1", all.f1);
        add("log_loss", "1", all.log_loss);
        add("ece", "1", all.ece);
        add("end_to_end_precision", "1", result.end_to_end.precision);
        add("end_to_end_recall", "1", result.end_to_end.recall);
        add("end_to_end_f1", "1", result.end_to_end.f1);
        add("policy_recall", "1", result.end_to_end.policy_recall);
        add("next_ahead_accuracy", "1", result.dark.next_ahead);
        add("place_error_median_m", "m", result.dark.place_median_m);
        add("place_error_p95_m", "m", result.dark.place_p95_m);
    }
    return rows;
}

std::string with_rows(std::string_view existing, const std::string& name,
                      const std::vector<ResultRow>& rows) {
    std::set<Key> keys;
    std::set<std::pair<std::string, std::string>> measures;
    for (const ResultRow& row : rows) {
        keys.insert(key_of(row));
        measures.emplace(row.study, row.measure);
    }
    std::string before, after;
    bool met = false;
    for (const ResultRow& row : rows_in(existing, name)) {
        const bool replaced = keys.contains(key_of(row)) ||
                              (row.origin == "product" && measures.contains({row.study, row.measure}));
        met = met || replaced;
        if (!replaced) (met ? after : before) += line_of(row);
    }
    std::string content = header() + before;
    for (const ResultRow& row : rows)
        content += line_of(row);
    return content + after;
}

std::string portable_command(const std::string& command, const std::string& root) {
    constexpr std::array left_out = {"--out", "--jobs"};
    namespace fs = std::filesystem;
    std::istringstream words(command);
    std::string text;
    for (std::string word; words >> word;) {
        const std::string name = word.substr(0, word.find('='));
        if (core::contains(left_out, name)) {
            if (name == word) words >> word;
            continue;
        }
        const fs::path path = word;
        if (text.empty()) {
            text = path.filename().string();
            continue;
        }
        if (path.is_absolute()) {
            const fs::path inside = path.lexically_relative(root);
            const bool is_inside = !root.empty() && !inside.empty() && *inside.begin() != "..";
            word = is_inside ? inside.string() : path.filename().string();
        }
        text += " " + word;
    }
    return text;
}

}  // namespace clearway::report
