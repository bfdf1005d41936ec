#include "analysis/summary.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "analysis/detail/pairing.hpp"
#include "core/fields.hpp"

namespace clearway::analysis {
namespace {

using detail::Runs;
using results::ConditionSpec;
using results::Engine;

template <class Member>
std::optional<double> as_number(const Member& member) {
    if constexpr (std::is_arithmetic_v<Member>) {
        return static_cast<double>(member);
    } else {
        return member;
    }
}

/// Metrics that average over the emergency vehicles that arrived, and the vehicle's number behind them.
std::optional<detail::VehicleNumber> vehicle_number_of(const std::string& metric) {
    if (metric == "emergency_travel_time_s") return &metrics::VehicleRow::travel_time_s;
    if (metric == "emergency_time_loss_s") return &metrics::VehicleRow::time_loss_s;
    return std::nullopt;
}

/// Values of a condition and its baseline, one a complete pair.
struct Pairs {
    std::vector<double> condition;
    std::vector<double> baseline;
};

Pairs pair_up(const std::string& metric, const Runs& condition, const Runs& baseline,
              Comparison& comparison) {
    Pairs pairs;
    const auto number = vehicle_number_of(metric);
    for (std::size_t replication = 0; replication < condition.size(); ++replication) {
        const std::array<const results::RunRecord*, 2> runs = {condition[replication], baseline[replication]};
        std::optional<double> with;
        std::optional<double> without;
        if (number) {
            if (const auto common = detail::common_means(runs, *number)) {
                with = common->means[0];
                without = common->means[1];
                comparison.vehicles_left_out += common->left_out;
            }
        } else if (runs[0] != nullptr && runs[1] != nullptr) {
            with = metric_value(runs[0]->metrics, metric);
            without = metric_value(runs[1]->metrics, metric);
        }
        if (with && without) {
            pairs.condition.push_back(*with);
            pairs.baseline.push_back(*without);
        }
    }
    comparison.complete_pairs = pairs.condition.size();
    comparison.incomplete_pairs = condition.size() - pairs.condition.size();
    return pairs;
}

/// BCa interval of the mean difference. For durations alone: counts are mostly small and often all zero.
std::optional<Interval> bootstrap_difference(const MetricInfo& metric, const Pairs& pairs, double level) {
    if (metric.unit != "s") return std::nullopt;
    BootstrapConfig config;
    config.level = level;
    const auto mean_difference = [&](std::span<const std::size_t> rows) {
        double sum = 0.0;
        for (const std::size_t row : rows)
            sum += pairs.condition[row] - pairs.baseline[row];
        return sum / static_cast<double>(rows.size());
    };
    return bootstrap_bca(pairs.condition.size(), mean_difference, config);
}

Comparison compare(const MetricInfo& metric, const Runs& condition, const Runs& baseline, double level) {
    Comparison comparison;
    const Pairs pairs = pair_up(metric.name, condition, baseline, comparison);
    comparison.difference = estimate_difference(pairs.condition, pairs.baseline, level);
    comparison.relative = relative_difference(pairs.condition, pairs.baseline, level);
    comparison.bootstrap = bootstrap_difference(metric, pairs, level);
    comparison.effect_size = effect_size(pairs.condition, pairs.baseline);
    comparison.t_p = paired_t_p(pairs.condition, pairs.baseline);
    comparison.wilcoxon_p = wilcoxon_p(pairs.condition, pairs.baseline);
    return comparison;
}

MetricSummary describe(const MetricInfo& metric, const Runs& runs, double level) {
    MetricSummary summary;
    summary.metric = metric;
    std::vector<double> present;
    for (const results::RunRecord* run : runs) {
        summary.values.push_back(run == nullptr ? std::nullopt : metric_value(run->metrics, metric.name));
        if (summary.values.back()) present.push_back(*summary.values.back());
    }
    summary.estimate = estimate_mean(present, level);
    if (!present.empty()) {
        summary.median = median(present);
        summary.percentile_95 = quantile(present, 0.95);
    }
    return summary;
}

void count(const metrics::VehicleRow& vehicle, OutcomeCounts& counts) {
    switch (vehicle.outcome) {
        case metrics::VehicleOutcome::arrived:
            ++counts.arrived;
            break;
        case metrics::VehicleOutcome::running_at_end:
            ++counts.running_at_end;
            break;
        case metrics::VehicleOutcome::teleported:
            ++counts.teleported;
            break;
        case metrics::VehicleOutcome::not_inserted:
            ++counts.not_inserted;
            break;
        case metrics::VehicleOutcome::removed:
            ++counts.removed;
            break;
    }
}

void count_outcomes(const Runs& runs, ConditionSummary& summary) {
    for (const results::RunRecord* run : runs) {
        if (run == nullptr) continue;
        ++summary.complete_runs;
        for (const metrics::VehicleRow& vehicle : run->vehicles) {
            const bool emergency = vehicle.vehicle_class == traffic::VehicleClass::emergency;
            count(vehicle, emergency ? summary.emergency : summary.others);
        }
    }
}

void close_gap(const Runs& condition, const Runs& baseline, const Runs& solo, double level,
               ConditionSummary& summary) {
    std::vector<double> with;
    std::vector<double> without;
    std::vector<double> alone;
    for (std::size_t replication = 0; replication < condition.size(); ++replication) {
        const std::array runs = {condition[replication], baseline[replication], solo[replication]};
        const auto common = detail::common_means(runs, &metrics::VehicleRow::travel_time_s);
        if (!common) continue;
        with.push_back(common->means[0]);
        without.push_back(common->means[1]);
        alone.push_back(common->means[2]);
    }
    summary.gap_replications = with.size();
    BootstrapConfig config;
    config.level = level;
    summary.gap_closed = gap_closed(with, without, alone, config);
}

/// The condition that `condition` is compared with, or nothing for baselines and solo.
const ConditionSpec* baseline_of(const ConditionSpec& condition, const std::vector<ConditionSpec>& all) {
    if (condition.engine == Engine::solo) return nullptr;
    const auto found = std::ranges::find_if(all, [&](const ConditionSpec& other) {
        return other.engine == condition.engine && other.parts.empty();
    });
    return found == all.end() || found->name == condition.name ? nullptr : &*found;
}

/// Adjusts each metric's p values over the conditions of a scenario.
void adjust(ScenarioSummary& scenario) {
    for (std::size_t metric = 0; metric < all_metrics().size(); ++metric) {
        std::vector<double> p_values;
        std::vector<Comparison*> owners;
        for (ConditionSummary& condition : scenario.conditions) {
            auto& comparison = condition.metrics[metric].comparison;
            if (!comparison || !comparison->t_p) continue;
            p_values.push_back(*comparison->t_p);
            owners.push_back(&*comparison);
        }
        const std::vector<double> adjusted = holm(p_values);
        for (std::size_t row = 0; row < owners.size(); ++row)
            owners[row]->holm_p = adjusted[row];
    }
}

/// Runs and failures of a study by scenario and condition.
class Index {
  public:
    explicit Index(const results::Results& results) : replications_(results.manifest.replications) {
        for (const results::RunRecord& run : results.runs) {
            Runs& runs = runs_[{run.key.scenario, run.key.condition}];
            runs.resize(replications_);
            runs.at(run.key.replication) = &run;
        }
        for (const results::FailureRecord& failure : results.failures)
            ++failures_[{failure.key.scenario, failure.key.condition}];
    }
    Runs runs(const std::string& scenario, const std::string& condition) const {
        const auto found = runs_.find({scenario, condition});
        return found == runs_.end() ? Runs(replications_) : found->second;
    }
    std::size_t failures(const std::string& scenario, const std::string& condition) const {
        const auto found = failures_.find({scenario, condition});
        return found == failures_.end() ? 0 : found->second;
    }

  private:
    using Cell = std::pair<std::string, std::string>;
    std::size_t replications_;
    std::map<Cell, Runs> runs_;
    std::map<Cell, std::size_t> failures_;
};

ConditionSummary summarise_condition(const Index& index, const std::string& scenario,
                                     const ConditionSpec& condition, const std::vector<ConditionSpec>& all,
                                     double level) {
    ConditionSummary summary;
    summary.condition = condition;
    const Runs runs = index.runs(scenario, condition.name);
    count_outcomes(runs, summary);
    summary.failed_runs = index.failures(scenario, condition.name);
    summary.missing_runs = runs.size() - summary.complete_runs - summary.failed_runs;
    for (const MetricInfo& metric : all_metrics())
        summary.metrics.push_back(describe(metric, runs, level));

    const ConditionSpec* baseline = baseline_of(condition, all);
    if (baseline == nullptr) return summary;
    summary.baseline = baseline->name;
    const Runs baseline_runs = index.runs(scenario, baseline->name);
    for (MetricSummary& metric : summary.metrics)
        metric.comparison = compare(metric.metric, runs, baseline_runs, level);
    const auto solo = std::ranges::find(all, Engine::solo, &ConditionSpec::engine);
    if (solo != all.end()) close_gap(runs, baseline_runs, index.runs(scenario, solo->name), level, summary);
    return summary;
}

}  // namespace

std::vector<MetricInfo> all_metrics() {
    std::vector<MetricInfo> metrics;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) {
        metrics.push_back({field.name, field.unit, field.doc});
    });
    return metrics;
}

std::optional<double> metric_value(const metrics::RunMetrics& metrics, const std::string& name) {
    bool known = false;
    std::optional<double> value;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) {
        if (name != field.name) return;
        known = true;
        value = as_number(metrics.*field.member);
    });
    if (!known) throw std::out_of_range("no metric " + name);
    return value;
}

const MetricSummary& ConditionSummary::metric(const std::string& name) const {
    for (const MetricSummary& summary : metrics) {
        if (summary.metric.name == name) return summary;
    }
    throw std::out_of_range("no metric " + name);
}

const ConditionSummary* ScenarioSummary::find(const std::string& condition) const {
    const auto found = std::ranges::find_if(
        conditions, [&](const ConditionSummary& summary) { return summary.condition.name == condition; });
    return found == conditions.end() ? nullptr : &*found;
}

Summary summarise(const results::Results& results, double level) {
    Summary summary;
    summary.manifest = results.manifest;
    summary.level = level;
    const Index index(results);
    for (const results::ScenarioEntry& entry : results.manifest.scenarios) {
        ScenarioSummary scenario{entry.name, entry.title, {}};
        for (const ConditionSpec& condition : results.manifest.conditions)
            scenario.conditions.push_back(
                summarise_condition(index, entry.name, condition, results.manifest.conditions, level));
        adjust(scenario);
        summary.scenarios.push_back(std::move(scenario));
    }
    return summary;
}

}  // namespace clearway::analysis
