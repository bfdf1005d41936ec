#include "report/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "experiment/settings.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

constexpr const char* others_metric = "others_time_loss_s";
constexpr std::size_t fewest_rows = 2;

/// The condition without its name, settings and factors.
experiment::ConditionSpec plain_recipe(experiment::ConditionSpec condition) {
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

/// The scenario decides about the environment, so it has no shipped value.
std::string shipped_value(const std::string& setting) {
    const std::size_t dot = setting.find('.');
    for (const experiment::Component& component : experiment::components()) {
        if (component.name != setting.substr(0, dot) || experiment::is_environment(component.name)) continue;
        for (const core::SettingInfo& row : component.table.rows) {
            if (component.name + "." + row.name == setting) return core::setting_text(row.preset);
        }
    }
    return "";
}

bool has_interval(const std::optional<analysis::Estimate>& difference) {
    return difference && difference->interval && difference->n >= analysis::fewest_for_interval;
}

SensitivityRow& row_of(Sensitivity& sensitivity, const std::string& setting) {
    const auto found = std::ranges::find(sensitivity.rows, setting, &SensitivityRow::setting);
    return found != sensitivity.rows.end()
               ? *found
               : sensitivity.rows.emplace_back(SensitivityRow{setting, shipped_value(setting), {}});
}

Sensitivity sensitivity_to(const analysis::ScenarioSummary& scenario,
                           const analysis::ConditionSummary& reference, const core::Settings& controls) {
    Sensitivity result{scenario.scenario, reference.condition.name, {}};
    const experiment::ConditionSpec recipe = plain_recipe(reference.condition);
    for (const analysis::ConditionSummary& condition : scenario.conditions) {
        if (condition.condition.settings.size() != 1 || plain_recipe(condition.condition) != recipe) continue;
        if (controls.contains(condition.condition.name)) continue;
        const auto& [setting, value] = *condition.condition.settings.begin();
        row_of(result, setting)
            .levels.push_back({condition.condition.name, value,
                               difference(condition, reference, analysis::primary_metric),
                               difference(condition, reference, others_metric),
                               analysis::emergency_objection_word(condition.objections)});
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

std::vector<Sensitivity> sensitivities(const analysis::Summary& summary, const core::Settings& controls) {
    std::vector<Sensitivity> all;
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        for (const analysis::ConditionSummary& condition : scenario.conditions) {
            if (!condition.condition.acts() || !condition.condition.settings.empty()) continue;
            Sensitivity sensitivity = sensitivity_to(scenario, condition, controls);
            if (sensitivity.rows.size() >= fewest_rows) all.push_back(std::move(sensitivity));
        }
    }
    return all;
}

std::string SensitivityRow::turned(const SensitivityLevel& level, const char* arrow) const {
    return shipped.empty() ? level.value : fmt::format("{} {} {}", shipped, arrow, level.value);
}

bool SensitivityRow::changes(std::optional<analysis::Estimate> SensitivityLevel::*difference) const {
    return std::ranges::any_of(levels, [&](const SensitivityLevel& level) {
        return has_interval(level.*difference) && !(level.*difference)->interval->contains(0.0);
    });
}

bool SensitivityRow::shows_nothing() const {
    const auto includes_zero = [](const std::optional<analysis::Estimate>& difference) {
        return has_interval(difference) && difference->interval->contains(0.0);
    };
    return std::ranges::all_of(levels, [&](const SensitivityLevel& level) {
        return level.objection.empty() && includes_zero(level.emergency) && includes_zero(level.others);
    });
}

bool Sensitivity::has_level(const std::string& of_scenario, const std::string& named) const {
    return scenario == of_scenario && std::ranges::any_of(rows, [&](const SensitivityRow& row) {
               return core::contains(row.levels, named, &SensitivityLevel::condition);
           });
}

std::string sensitivity_sentence(const Sensitivity& sensitivity) {
    const auto changing = [&](std::optional<analysis::Estimate> SensitivityLevel::*difference) {
        return std::ranges::count_if(sensitivity.rows,
                                     [&](const SensitivityRow& row) { return row.changes(difference); });
    };
    const bool too_few = std::ranges::none_of(sensitivity.rows, [](const SensitivityRow& row) {
        return std::ranges::any_of(row.levels, [](const SensitivityLevel& level) {
            return has_interval(level.emergency) || has_interval(level.others);
        });
    });
    if (too_few)
        return fmt::format(
            "{}: {} settings of {} were each turned alone, but fewer than {} seeds give no interval",
            sensitivity.scenario, sensitivity.rows.size(), sensitivity.condition,
            analysis::fewest_for_interval);
    return fmt::format(
        "{}: EV travel time is changed by {} of {} settings of {}, each turned alone, and the others' time "
        "loss by {} (the 95 % interval of a paired difference excludes 0)",
        sensitivity.scenario, changing(&SensitivityLevel::emergency), sensitivity.rows.size(),
        sensitivity.condition, changing(&SensitivityLevel::others));
}

std::string sensitivity_table(const std::vector<Sensitivity>& all, SensitivityRows rows) {
    std::string text;
    auto out = std::back_inserter(text);
    const NumberStyle style{.decimals = 1, .sign = Sign::ends_too};
    for (const Sensitivity& sensitivity : all) {
        fmt::format_to(out, "Sensitivity: {}, {}; differences to the defaults\n\n", sensitivity.scenario,
                       sensitivity.condition);
        fmt::format_to(out, "{:<32}{:<24}{}\n{:-<80}\n", "Setting, shipped -> turned to", "EV travel time, s",
                       "others' time loss, s", "");
        std::size_t left_out = 0;
        for (const SensitivityRow& row : sensitivity.rows) {
            if (rows == SensitivityRows::with_effect && row.shows_nothing()) {
                ++left_out;
                continue;
            }
            fmt::format_to(out, "{}\n", row.setting);
            for (const SensitivityLevel& level : row.levels)
                fmt::format_to(
                    out, "  {:<30}{:<24}{}\n",
                    row.turned(level, "->") + (level.objection.empty() ? "" : ", " + level.objection),
                    estimate(level.emergency, style), estimate(level.others, style));
        }
        if (left_out > 0)
            fmt::format_to(out, "{} without a shown effect: both intervals include 0 (--tables)\n",
                           counted(left_out, "setting"));
        text += '\n';
    }
    return text;
}

}  // namespace clearway::report
