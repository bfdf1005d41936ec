#include "report/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "report/text.hpp"

namespace clearway::report {
namespace {

constexpr const char* others_metric = "others_time_loss_s";
constexpr std::size_t fewest_rows = 2;

/// The condition without its name, settings and factors.
experiment::ConditionSpec recipe_of(experiment::ConditionSpec condition) {
    condition.name.clear();
    condition.settings.clear();
    condition.factors.clear();
    return condition;
}

std::optional<analysis::Estimate> difference(const analysis::ConditionSummary& condition,
                                             const analysis::ConditionSummary& reference,
                                             const char* metric) {
    const analysis::MetricSummary& values = condition.metric(metric);
    return analysis::estimate_paired(values.values, reference.metric(metric).values, values.metric.kind);
}

SensitivityRow& row_of(Sensitivity& sensitivity, const std::string& setting) {
    const auto found = std::ranges::find(sensitivity.rows, setting, &SensitivityRow::setting);
    return found != sensitivity.rows.end() ? *found
                                           : sensitivity.rows.emplace_back(SensitivityRow{setting, {}});
}

Sensitivity sensitivity_to(const analysis::ScenarioSummary& scenario,
                           const analysis::ConditionSummary& reference) {
    Sensitivity result{scenario.scenario, reference.condition.name, {}};
    const experiment::ConditionSpec recipe = recipe_of(reference.condition);
    for (const analysis::ConditionSummary& condition : scenario.conditions) {
        if (condition.condition.settings.size() != 1 || recipe_of(condition.condition) != recipe) continue;
        const auto& [setting, value] = *condition.condition.settings.begin();
        row_of(result, setting)
            .levels.push_back({value, difference(condition, reference, analysis::primary_metric),
                               difference(condition, reference, others_metric)});
    }
    std::ranges::stable_sort(result.rows, std::ranges::greater(), &SensitivityRow::reach_s);
    return result;
}

}  // namespace

double SensitivityRow::reach_s() const {
    double reach = 0.0;
    for (const SensitivityLevel& level : levels) {
        if (level.emergency) reach = std::max(reach, std::abs(level.emergency->mean));
    }
    return reach;
}

std::vector<Sensitivity> sensitivities(const analysis::Summary& summary) {
    std::vector<Sensitivity> all;
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        for (const analysis::ConditionSummary& condition : scenario.conditions) {
            if (!condition.condition.acts() || !condition.condition.settings.empty()) continue;
            Sensitivity sensitivity = sensitivity_to(scenario, condition);
            if (sensitivity.rows.size() >= fewest_rows) all.push_back(std::move(sensitivity));
        }
    }
    return all;
}

std::string sensitivity_table(const std::vector<Sensitivity>& all) {
    std::string text;
    auto out = std::back_inserter(text);
    const NumberStyle style{.decimals = 1, .sign = Sign::always};
    for (const Sensitivity& sensitivity : all) {
        fmt::format_to(out, "Sensitivity: {}, {}; differences to the defaults\n\n", sensitivity.scenario,
                       sensitivity.condition);
        fmt::format_to(out, "{:<32}{:<24}{}\n{:-<80}\n", "Setting", "EV travel time, s",
                       "others' time loss, s", "");
        for (const SensitivityRow& row : sensitivity.rows) {
            fmt::format_to(out, "{}\n", row.setting);
            for (const SensitivityLevel& level : row.levels)
                fmt::format_to(out, "  {:<30}{:<24}{}\n", level.value, estimate(level.emergency, style),
                               estimate(level.others, style));
        }
        text += '\n';
    }
    return text;
}

}  // namespace clearway::report
