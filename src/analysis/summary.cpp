#include "analysis/summary.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/detail/condition_leases.hpp"
#include "analysis/detail/condition_summary.hpp"
#include "core/fields.hpp"
#include "experiment/related_conditions.hpp"
#include "metrics/run_metrics.hpp"
#include "traffic/lease.hpp"

namespace clearway::analysis {
namespace {

using detail::Index;
using detail::Pairs;
using detail::pairs_of;
using detail::ResampleCache;
using detail::Runs;
using experiment::ConditionSpec;
using experiment::TrafficModel;

template <class Member>
std::optional<double> as_number(const Member& member) {
    if constexpr (std::is_arithmetic_v<Member>) {
        return static_cast<double>(member);
    } else {
        return member;
    }
}

/// The vehicle's metric behind a run's metric that averages over the emergency vehicles that arrived; else
/// nothing.
std::optional<detail::VehicleNumber> vehicle_number_of(const std::string& metric) {
    if (metric == "emergency_travel_time_s") return &metrics::VehicleRow::travel_time_s;
    if (metric == "emergency_time_loss_s") return &metrics::VehicleRow::time_loss_s;
    return std::nullopt;
}

/// Means over the vehicles that arrived in both conditions.
Pairs pairs_of_common_vehicles(detail::VehicleNumber number, const Runs& condition, const Runs& baseline,
                               Comparison& comparison) {
    Pairs pairs;
    for (std::size_t replication = 0; replication < std::min(condition.size(), baseline.size());
         ++replication) {
        const std::array runs = {condition[replication], baseline[replication]};
        const auto common = detail::common_means(runs, number);
        if (!common) continue;
        pairs.add(common->means[0], common->means[1]);
        comparison.vehicles_left_out += common->left_out;
    }
    return pairs;
}

MaybeEstimate difference_of(const Pairs& pairs, MetricKind kind, double level) {
    return kind == MetricKind::count ? estimate_count_difference(pairs.condition, pairs.baseline, level)
                                     : estimate_difference(pairs.condition, pairs.baseline, level);
}

std::vector<double> differences_of(const Pairs& pairs) {
    std::vector<double> differences(pairs.condition.size());
    std::ranges::transform(pairs.condition, pairs.baseline, differences.begin(), std::minus<>());
    return differences;
}

void compare(const Pairs& pairs, MetricKind kind, ResampleCache& resamples, Comparison& comparison) {
    const double level = resamples.level();
    comparison.complete_pairs = pairs.condition.size();
    comparison.difference = difference_of(pairs, kind, level);
    comparison.relative = relative_difference(pairs.condition, pairs.baseline, level);
    comparison.effect_size = effect_size(pairs.condition, pairs.baseline);
    comparison.wilcoxon_p = wilcoxon_p(pairs.condition, pairs.baseline);
    if (pairs.condition.empty()) return;
    const std::vector<double> differences = differences_of(pairs);
    comparison.median = median(differences);
    comparison.median_interval = quantile_interval(differences, 0.5, level);
    if (kind == MetricKind::count) return;
    comparison.t_p = paired_t_p(pairs.condition, pairs.baseline);
    comparison.bootstrap = bootstrap_bca_of_mean(resamples.of(differences.size()), differences);
}

/// The values of the replications in which neither run locked.
Values without_locks(Values values, const Values& locks, const Values& baseline_locks) {
    for (std::size_t row = 0; row < values.size(); ++row) {
        const bool locked = (row < locks.size() && locks[row].value_or(0.0) > 0.0) ||
                            (row < baseline_locks.size() && baseline_locks[row].value_or(0.0) > 0.0);
        if (locked) values[row].reset();
    }
    return values;
}

/// Replications with a value in both conditions, in one of whose runs locks held up traffic.
std::size_t held_up_pairs(const Runs& runs, const Runs& baseline_runs, const Values& values,
                          const Values& base) {
    std::size_t count = 0;
    for (std::size_t row = 0; row < std::min(values.size(), base.size()); ++row)
        if (values[row] && base[row] &&
            (metrics::is_held_up(runs[row]->metrics) || metrics::is_held_up(baseline_runs[row]->metrics)))
            ++count;
    return count;
}

/// All metrics of all runs of a condition, each by replication.
std::vector<Values> values_of(const Runs& runs) {
    std::vector<Values> values(all_metrics().size(), Values(runs.size()));
    for (std::size_t replication = 0; replication < runs.size(); ++replication) {
        if (runs[replication] == nullptr) continue;
        std::size_t metric = 0;
        core::for_each_field<metrics::RunMetrics>([&](const auto& field) {
            values[metric++][replication] = as_number(runs[replication]->metrics.*field.member);
        });
    }
    return values;
}

std::vector<double> present_in(const Values& values) {
    std::vector<double> present;
    for (const std::optional<double>& value : values) {
        if (value) present.push_back(*value);
    }
    return present;
}

MetricSummary describe(const MetricInfo& metric, Values values, double level) {
    MetricSummary summary;
    summary.metric = metric;
    summary.estimate = estimate_values(values, metric.kind, level);
    summary.values = std::move(values);
    return summary;
}

TravelTimeTail tail_of(const Runs& runs, ResampleCache& resamples) {
    std::vector<Cluster> clusters;
    std::size_t trips = 0;
    for (const results::RunRecord* run : runs) {
        if (run == nullptr) continue;
        Cluster& cluster = clusters.emplace_back();
        for (const metrics::VehicleRow& vehicle : run->vehicles) {
            if (vehicle.vehicle_class != traffic::VehicleClass::emergency) continue;
            ++trips;
            if (vehicle.outcome == metrics::VehicleOutcome::arrived && vehicle.travel_time_s) {
                cluster.values.push_back(*vehicle.travel_time_s);
            } else {
                ++cluster.without_value;
            }
        }
    }
    if (clusters.empty()) return {};
    const Resamples& drawn = resamples.of(clusters.size());
    TravelTimeTail tail{pooled_quantile(clusters, 0.5, drawn), {}};
    if (trips >= TravelTimeTail::fewest_trips) tail.percentile_95 = pooled_quantile(clusters, 0.95, drawn);
    return tail;
}

void count_outcomes(const Runs& runs, ConditionSummary& summary) {
    for (const results::RunRecord* run : runs) {
        if (run == nullptr) continue;
        ++summary.complete_runs;
        summary.emergency += emergency_outcomes(*run);
        summary.others += other_outcomes(*run);
    }
}

bool have_same_traces(const Runs& left, const Runs& right) {
    const auto same = [](const results::RunRecord* one, const results::RunRecord* other) {
        return one != nullptr && other != nullptr && !one->provenance.trace_hash.empty() &&
               one->provenance.trace_hash == other->provenance.trace_hash;
    };
    return !left.empty() && std::ranges::equal(left, right, same);
}

/// See ConditionSummary::same_as.
void find_same(const Index& index, ScenarioSummary& scenario) {
    std::vector<Runs> runs;
    for (ConditionSummary& summary : scenario.conditions) {
        runs.push_back(index.runs(scenario.scenario, summary.condition.name));
        const auto found = std::ranges::find_if(
            runs, [&](const Runs& earlier) { return have_same_traces(earlier, runs.back()); });
        const std::size_t place = static_cast<std::size_t>(found - runs.begin());
        if (place + 1 < runs.size()) summary.same_as = scenario.conditions[place].condition.name;
    }
}

void close_gap(const Runs& condition, const Runs& baseline, const Runs& solo, ResampleCache& resamples,
               ConditionSummary& summary) {
    std::vector<double> with;
    std::vector<double> without;
    std::vector<double> alone;
    for (std::size_t replication = 0; replication < condition.size(); ++replication) {
        const std::array runs = {condition[replication], baseline[replication], solo[replication]};
        const auto has_value = [](const results::RunRecord* run) {
            return run != nullptr && run->metrics.emergency_restricted_travel_time_s;
        };
        if (!std::ranges::all_of(runs, has_value)) continue;
        with.push_back(*runs[0]->metrics.emergency_restricted_travel_time_s);
        without.push_back(*runs[1]->metrics.emergency_restricted_travel_time_s);
        alone.push_back(*runs[2]->metrics.emergency_restricted_travel_time_s);
    }
    summary.gap_closed = gap_closed(with, without, alone, resamples.of(with.size()));
}

/// The name that a study file gave: what follows `+` was added by factors.
std::string_view given_name(const ConditionSpec& condition) {
    return std::string_view(condition.name).substr(0, condition.name.find('+'));
}

/// The condition that `condition` is compared with. Nullptr for solo, for the reference itself and where
/// there is none.
const ConditionSpec* compared_with(const ConditionSpec& condition, const std::vector<ConditionSpec>& all,
                                   const Reference& reference) {
    if (condition.traffic_model == TrafficModel::free_flow) return nullptr;
    core::Settings levels = condition.factors;
    for (const auto& [factor, level] : reference.levels)
        levels[factor] = level;
    const auto found = std::ranges::find_if(all, [&](const ConditionSpec& other) {
        if (!experiment::same_environment(other, condition)) return false;
        if (!reference.levels.empty())
            return other.factors == levels && given_name(other) == given_name(condition);
        return reference.name.empty() ? !other.acts() : other.name == reference.name;
    });
    return found == all.end() || found->name == condition.name ? nullptr : &*found;
}

/// Reference::Chosen::best for `condition`, by a summary against the baselines; nullptr where there is none.
const ConditionSpec* best_other(const ConditionSpec& condition, const ScenarioSummary& usual) {
    const auto circumstances = [](const ConditionSpec& one) {
        core::Settings factors = one.factors;
        factors.erase("condition.policy");
        factors["failure"] = one.failure;
        return factors;
    };
    const ConditionSpec* best = nullptr;
    double least_s = 0.0;
    for (const ConditionSummary& other : usual.conditions) {
        const std::optional<double> mean_s = mean_of(other.metric(primary_metric).estimate);
        if (!mean_s || !other.condition.acts() || other.objections.on_emergency() ||
            other.condition.name == condition.name ||
            !experiment::same_environment(other.condition, condition) ||
            circumstances(other.condition) != circumstances(condition))
            continue;
        if (best == nullptr || *mean_s < least_s) {
            best = &other.condition;
            least_s = *mean_s;
        }
    }
    return best;
}

/// Gives each its p value corrected for all of them: pairs of the p value and its place.
void correct(const std::vector<std::pair<double, std::optional<double>*>>& tests) {
    std::vector<double> p_values;
    for (const auto& test : tests)
        p_values.push_back(test.first);
    const std::vector<double> adjusted = holm(p_values);
    for (std::size_t test = 0; test < tests.size(); ++test)
        *tests[test].second = adjusted[test];
}

}  // namespace

namespace detail {

void adjust(ScenarioSummary& scenario) {
    std::vector<std::pair<double, std::optional<double>*>> approaches;
    for (ConditionSummary& condition : scenario.conditions)
        for (ApproachCost& approach : condition.approaches)
            if (approach.t_p) approaches.emplace_back(*approach.t_p, &approach.holm_p);
    correct(approaches);
    for (std::size_t metric = 0; metric < all_metrics().size(); ++metric) {
        std::vector<std::pair<double, std::optional<double>*>> tests;
        for (ConditionSummary& condition : scenario.conditions) {
            auto& comparison = condition.metrics[metric].comparison;
            if (!comparison) continue;
            const bool counted = condition.metrics[metric].metric.kind == MetricKind::count;
            const std::optional<double> p = counted ? comparison->wilcoxon_p : comparison->t_p;
            if (p) tests.emplace_back(*p, &comparison->holm_p);
        }
        correct(tests);
    }
}

void compare_conditions(const Runs& runs, const Runs& baseline_runs, const ConditionSummary& baseline,
                        ResampleCache& resamples, ConditionSummary& summary) {
    const Values& locks = summary.metric("locks").values;
    const Values& baseline_locks = baseline.metric("locks").values;
    for (std::size_t metric = 0; metric < summary.metrics.size(); ++metric) {
        MetricSummary& one = summary.metrics[metric];
        Comparison& comparison = one.comparison.emplace();
        const auto number = vehicle_number_of(one.metric.name);
        const Pairs pairs = number ? pairs_of_common_vehicles(*number, runs, baseline_runs, comparison)
                                   : pairs_of(one.values, baseline.metrics[metric].values);
        compare(pairs, one.metric.kind, resamples, comparison);
        comparison.incomplete_pairs = std::max(runs.size(), baseline_runs.size()) - comparison.complete_pairs;
        const Values& base = baseline.metrics[metric].values;
        const Pairs unlocked = pairs_of(without_locks(one.values, locks, baseline_locks), base);
        comparison.locked_pairs = pairs_of(one.values, base).condition.size() - unlocked.condition.size();
        if (comparison.locked_pairs > 0) {
            comparison.held_up_pairs = held_up_pairs(runs, baseline_runs, one.values, base);
            comparison.unlocked = difference_of(unlocked, one.metric.kind, resamples.level());
        }
        comparison.condition_values = pairs.condition;
        comparison.baseline_values = pairs.baseline;
    }
    summary.objections =
        objections_to(runs, baseline_runs, summary.condition.safety_checks, resamples.level());
    summary.approaches = approach_costs(runs, baseline_runs, resamples.level());
    summary.recovery = recovery_after(runs, baseline_runs, resamples.level());
}

ConditionSummary describe_condition(const Index& index, const std::string& scenario,
                                    const ConditionSpec& condition, ResampleCache& resamples) {
    ConditionSummary summary;
    summary.condition = condition;
    const Runs runs = index.runs(scenario, condition.name);
    count_outcomes(runs, summary);
    summary.leases = detail::leases_of(runs);
    summary.idle_parts = detail::idle_parts(runs, condition);
    summary.failed_runs = index.errors(scenario, condition.name);
    summary.missing_runs = runs.size() - summary.complete_runs - summary.failed_runs;
    summary.travel_time = tail_of(runs, resamples);
    std::vector<Values> values = values_of(runs);
    const std::vector<MetricInfo> metrics = all_metrics();
    for (std::size_t metric = 0; metric < metrics.size(); ++metric) {
        summary.metrics.push_back(describe(metrics[metric], std::move(values[metric]), resamples.level()));
    }
    return summary;
}

double threshold_of(const Index& index, const std::string& scenario,
                    const std::vector<ConditionSpec>& conditions, std::optional<double> given_s) {
    if (given_s) return *given_s;
    Runs all;
    for (const ConditionSpec& condition : conditions) {
        const Runs runs = index.runs(scenario, condition.name);
        all.insert(all.end(), runs.begin(), runs.end());
    }
    return usual_response_threshold_s(all).value_or(0.0);
}

void add_unfinished(const std::string& scenario, const ConditionSummary& condition, const char* folder,
                    std::vector<Unpaired>& unpaired) {
    const std::size_t lost = condition.failed_runs + condition.missing_runs;
    if (lost == 0) return;
    unpaired.push_back(
        {scenario, condition.condition.name,
         fmt::format("{} of {} runs failed or are missing{}", lost, lost + condition.complete_runs, folder)});
}

}  // namespace detail

namespace {

/// As `summarise` takes them.
struct Choices {
    std::optional<double> response_threshold_s;
    Reference reference;
};

ScenarioSummary summarise_scenario(const Index& index, const results::ScenarioEntry& entry,
                                   const std::vector<ConditionSpec>& conditions, ResampleCache& resamples,
                                   const Choices& choices) {
    const double threshold_s =
        detail::threshold_of(index, entry.name, conditions, choices.response_threshold_s);
    std::optional<ScenarioSummary> usual;
    if (choices.reference.is_best())
        usual = summarise_scenario(index, entry, conditions, resamples, {choices.response_threshold_s, {}});
    ScenarioSummary scenario{entry.name, entry.title, {}};
    for (const ConditionSpec& condition : conditions)
        scenario.conditions.push_back(detail::describe_condition(index, entry.name, condition, resamples));
    find_same(index, scenario);
    const auto solo = std::ranges::find(conditions, TrafficModel::free_flow, &ConditionSpec::traffic_model);
    for (ConditionSummary& summary : scenario.conditions) {
        const ConditionSpec* const baseline =
            usual ? best_other(summary.condition, *usual)
                  : compared_with(summary.condition, conditions, choices.reference);
        const Runs runs = index.runs(entry.name, summary.condition.name);
        const Runs baseline_runs = baseline == nullptr ? Runs{} : index.runs(entry.name, baseline->name);
        summary.response = response_of(runs, baseline_runs, threshold_s, resamples.level());
        if (baseline == nullptr) continue;
        summary.baseline = baseline->name;
        summary.met_incident = met_incident(runs, baseline_runs, resamples.level());
        detail::compare_conditions(runs, baseline_runs, *scenario.find(baseline->name), resamples, summary);
        if (solo == conditions.end() || !choices.reference.is_baseline()) continue;
        close_gap(runs, baseline_runs, index.runs(entry.name, solo->name), resamples, summary);
    }
    detail::adjust(scenario);
    return scenario;
}

}  // namespace

std::string to_text(const Reference& reference) {
    if (reference.is_best()) return "the best other condition";
    if (reference.levels.empty()) return reference.name;
    std::vector<std::string> levels;
    for (const auto& [factor, level] : reference.levels)
        levels.push_back(fmt::format("{} {}", factor.substr(factor.rfind('.') + 1), level));
    return fmt::format("its counterpart with {}", fmt::join(levels, " and "));
}

std::vector<MetricInfo> all_metrics() {
    std::vector<MetricInfo> infos;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) {
        using Member = std::decay_t<decltype(std::declval<metrics::RunMetrics>().*field.member)>;
        const MetricKind kind = std::is_integral_v<Member> ? MetricKind::count : MetricKind::quantity;
        infos.push_back({field.name, field.unit, field.doc, kind});
    });
    return infos;
}

MaybeEstimate estimate_values(const Values& values, MetricKind kind, double level) {
    const std::vector<double> present = present_in(values);
    return kind == MetricKind::count ? estimate_count(present, level) : estimate_not_negative(present, level);
}

MaybeEstimate estimate_paired(const Values& condition, const Values& baseline, MetricKind kind,
                              double level) {
    return difference_of(pairs_of(condition, baseline), kind, level);
}

std::optional<double> paired_t_p(const Values& condition, const Values& baseline) {
    const Pairs pairs = pairs_of(condition, baseline);
    return paired_t_p(pairs.condition, pairs.baseline);
}

const MetricSummary& ConditionSummary::metric(std::string_view name) const {
    for (const MetricSummary& summary : metrics) {
        if (summary.metric.name == name) return summary;
    }
    throw std::out_of_range(fmt::format("no metric {}", name));
}

double ConditionSummary::total(std::string_view name) const {
    double sum = 0.0;
    for (const std::optional<double>& value : metric(name).values)
        sum += value.value_or(0.0);
    return sum;
}

std::size_t ConditionSummary::locked_runs() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(metric("locks").values,
                              [](const std::optional<double>& locks) { return locks.value_or(0.0) > 0.0; }));
}

const ConditionSummary* ScenarioSummary::find(const std::string& condition) const {
    const auto found = std::ranges::find_if(
        conditions, [&](const ConditionSummary& summary) { return summary.condition.name == condition; });
    return found == conditions.end() ? nullptr : &*found;
}

Summary summarise(const results::Results& results, double level, std::optional<double> response_threshold_s,
                  const Reference& reference) {
    Summary summary;
    summary.manifest = results.manifest;
    summary.level = level;
    const Index index(results);
    ResampleCache resamples(level);
    for (const results::ScenarioEntry& entry : results.manifest.scenarios) {
        summary.scenarios.push_back(summarise_scenario(index, entry, results.manifest.conditions, resamples,
                                                       {response_threshold_s, reference}));
        for (const ConditionSummary& condition : summary.scenarios.back().conditions)
            detail::add_unfinished(entry.name, condition, "", summary.unpaired);
    }
    return summary;
}

}  // namespace clearway::analysis
