#include "report/read_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/estimate.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/strict_table.hpp"
#include "experiment/settings.hpp"
#include "prediction/predictor.hpp"
#include "report/detail/map_facts.hpp"
#include "report/detail/safety_facts.hpp"
#include "report/detail/traffic_facts.hpp"
#include "report/text.hpp"
#include "results/factor_columns.hpp"

namespace clearway::report {
namespace {

namespace fs = std::filesystem;
using ConditionKey = std::pair<std::string, std::string>;  // scenario, condition

/// The dissertation's names for its conditions, and Clearway's names for the controls. A condition that
/// repairs the graph is named after its predictor.
std::string title_of(const experiment::ConditionSpec& condition) {
    static const std::map<std::string, std::string> titles = {
        {"baseline", "Baseline"},
        {"graph_simulation", "Graph made by simulation attributes"},
        {"solo", "Alone on the road, signals open"},
    };
    if (const auto found = titles.find(condition.name); found != titles.end()) return found->second;
    const std::string repair =
        prediction::title_of(condition.predictor) + (condition.model_file.empty() ? "" : ", other weights");
    if (condition.name.starts_with("graph_graphsage")) return repair;
    if (condition.name == "b10_no_repair" || condition.name == "b10_dead_reckoning")
        return "Same failures, " + repair;
    return condition.name;
}

/// The scenario of the dissertation whose table a scenario of its study stands beside.
std::string published_scenario(const std::string& scenario) {
    return scenario == "merge_dense" ? "merge" : scenario;
}

std::string recipe_of(const experiment::ConditionSpec& condition) {
    const std::string settings = experiment::settings_text(condition);
    return fmt::format(
        "sensing {}; repair {}; policy {}; traffic model {}; safety checks {}{}{}", condition.failure,
        condition.predictor,
        condition.policies.empty() ? "none" : fmt::format("{}", fmt::join(condition.policies, " + ")),
        experiment::name(condition.traffic_model), experiment::name(condition.safety_checks),
        condition.bluelight == traffic::BlueLight::on ? "; device.bluelight" : "",
        settings.empty() ? "" : "; " + settings);
}

using detail::estimate_from;

Endings endings_from(const analysis::OutcomeCounts& counts) {
    return {counts.arrived, counts.running_at_end, counts.teleported, counts.not_inserted, counts.removed};
}

using analysis::Values;

/// Vehicles that did not arrive, by replication: the sum of three metrics.
Values not_arrived(const analysis::ConditionSummary& condition) {
    Values total;
    for (const char* const name : {"unfinished", "not_inserted", "removed"}) {
        const Values& values = condition.metric(name).values;
        if (total.empty()) {
            total = values;
            continue;
        }
        for (std::size_t row = 0; row < values.size(); ++row) {
            total[row] = total[row] && values[row] ? std::optional(*total[row] + *values[row]) : std::nullopt;
        }
    }
    return total;
}

Estimate estimate_with(const std::optional<double>& mean, const std::optional<analysis::Interval>& interval,
                       std::uint64_t count) {
    Estimate result{mean, std::nullopt, std::nullopt, count};
    if (interval) {
        result.low = interval->low;
        result.high = interval->high;
    }
    return result;
}

PairedStatistics statistics_of(const analysis::Comparison& comparison) {
    const auto mean = comparison.difference ? std::optional(comparison.difference->mean) : std::nullopt;
    return {.complete_pairs = comparison.complete_pairs,
            .incomplete_pairs = comparison.incomplete_pairs,
            .vehicles_left_out = comparison.vehicles_left_out,
            .bootstrap = estimate_with(mean, comparison.bootstrap, comparison.complete_pairs),
            .median = estimate_with(comparison.median, comparison.median_interval, comparison.complete_pairs),
            .effect_size = comparison.effect_size,
            .t_p = comparison.t_p,
            .wilcoxon_p = comparison.wilcoxon_p,
            .holm_p = comparison.holm_p};
}

/// Fills every measure that the summary holds under the name of its field.
void fill_outcomes(const analysis::ConditionSummary& summary, const analysis::ConditionSummary* baseline,
                   double level, ConditionFacts& facts) {
    for (const MeasureInfo& measure : measures()) {
        Outcome& outcome = facts.outcome(measure.measure);
        if (measure.measure == Measure::gap_closed) {
            // An EV that did not arrive counts with the horizon, so the share would be a large negative
            // number.
            if (!summary.gap_closed || summary.objections.loses_emergency()) continue;
            outcome.value = estimate_with(summary.gap_closed->value, summary.gap_closed->interval,
                                          summary.gap_replications);
        } else if (measure.measure == Measure::unfinished) {
            const Values values = not_arrived(summary);
            const auto kind = analysis::MetricKind::count;
            outcome.value = estimate_from(analysis::estimate_values(values, kind, level));
            if (baseline != nullptr)
                outcome.difference =
                    estimate_from(analysis::estimate_paired(values, not_arrived(*baseline), kind, level));
        } else {
            const analysis::MetricSummary& metric = summary.metric(measure.field);
            outcome.value = estimate_from(metric.estimate);
            if (!metric.comparison) continue;
            outcome.difference = estimate_from(metric.comparison->difference);
            outcome.paired = statistics_of(*metric.comparison);
        }
    }
}

/// Half widths as replications were added. Means and sums of squares by Welford 1962.
std::optional<Precision> precision_of(const std::vector<TravelTimePair>& pairs, double level,
                                      double least_relevant_s) {
    constexpr std::size_t first_drawn = 5;  // with fewer, large t quantiles would dwarf the rest of the curve
    if (pairs.size() < 2) return std::nullopt;
    Precision precision;
    const std::size_t stride = pairs.size() / precision_points + 1;
    double mean = 0.0;
    double squares = 0.0;
    for (std::size_t n = 1; n <= pairs.size(); ++n) {
        const double difference = pairs[n - 1].condition_s - pairs[n - 1].baseline_s;
        const double before = difference - mean;
        mean += before / static_cast<double>(n);
        squares += before * (difference - mean);
        if (n < 2) continue;
        precision.deviation_s = std::sqrt(squares / static_cast<double>(n - 1));
        if (n >= first_drawn && ((pairs.size() - n) % stride == 0))
            precision.points.push_back({n, analysis::half_width(precision.deviation_s, n, level)});
    }
    const double wanted_s = least_relevant_s > 0.0 ? least_relevant_s : usual_least_relevant_s;
    precision.needed = std::max(analysis::fewest_replications,
                                analysis::required_replications(precision.deviation_s, wanted_s, level));
    return precision;
}

void fill_pairs(const analysis::ConditionSummary& summary, double level, double least_relevant_s,
                ConditionFacts& facts) {
    const auto& comparison = summary.metric(analysis::primary_metric).comparison;
    if (!comparison) return;
    for (std::size_t pair = 0; pair < comparison->complete_pairs; ++pair)
        facts.travel_time_pairs.push_back(
            {comparison->baseline_values[pair], comparison->condition_values[pair]});
    facts.precision = precision_of(facts.travel_time_pairs, level, least_relevant_s);
}

void fill_traffic(const analysis::ConditionSummary& summary, ConditionFacts& facts) {
    for (const analysis::ApproachCost& cost : summary.approaches)
        facts.approaches.push_back({cost.edge, "", estimate_from(cost.difference), estimate_from(cost.human),
                                    estimate_from(cost.automated), estimate_from(cost.waiting),
                                    cost.baseline_s, cost.vehicles, cost.per_vehicle_s});
    if (!summary.recovery) return;
    facts.recovered_after_s = summary.recovery->recovered_after_s;
    for (const analysis::RecoveryPoint& point : summary.recovery->points)
        facts.recovery.push_back({point.offset_s, estimate_from(point.difference)});
}

std::uint64_t total_of(const analysis::ConditionSummary& summary, const char* metric) {
    double total = 0.0;
    for (const std::optional<double>& value : summary.metric(metric).values)
        total += value.value_or(0.0);
    return static_cast<std::uint64_t>(total);
}

Events events_of(const analysis::ConditionSummary& summary) {
    return {.leases_issued = total_of(summary, "leases_issued"),
            .leases_refused = total_of(summary, "leases_refused"),
            .leases_expired = total_of(summary, "leases_expired"),
            .collisions = total_of(summary, "collisions"),
            .emergency_collisions = total_of(summary, "emergency_collisions"),
            .teleports = total_of(summary, "teleports")};
}

Estimate estimate_from(const analysis::PooledQuantile& quantile, std::uint64_t replications) {
    return estimate_with(quantile.value, quantile.interval, replications);
}

Estimate estimate_from(const std::optional<analysis::TripStatistic>& trips, std::uint64_t replications) {
    return trips ? estimate_with(trips->value, trips->interval, replications) : Estimate{};
}

void fill_response(const analysis::ResponseTime& response, ConditionFacts& facts) {
    facts.response_percentile_90.value = estimate_from(response.percentile_90_s, response.replications);
    facts.response_percentile_90.difference =
        estimate_from(response.percentile_90_difference_s, response.pairs);
    facts.response_in_time.value = estimate_from(response.in_time, response.replications);
    facts.response_in_time.difference = estimate_from(response.in_time_difference, response.pairs);
}

ScenarioFacts scenario_facts(const analysis::ScenarioSummary& summary, const results::Manifest& manifest,
                             double level, double least_relevant_s) {
    ScenarioFacts facts;
    facts.name = summary.scenario;
    if (manifest.study == "dissertation") facts.published_as = published_scenario(summary.scenario);
    facts.title = summary.title;
    facts.replications = manifest.replications;
    facts.least_relevant_s = least_relevant_s;
    const results::FactorColumns factors(manifest);
    for (const analysis::ConditionSummary& one : summary.conditions) {
        ConditionFacts condition;
        condition.name = one.condition.name;
        condition.title = title_of(one.condition);
        condition.recipe = recipe_of(one.condition);
        condition.factors = factors.settings(summary.scenario, condition.name);
        condition.safety_checks_off = one.condition.safety_checks == traffic::SafetyChecks::off;
        condition.objections = one.objections;
        condition.runs_without_horizon = one.runs_without_horizon;
        condition.has_policy = !one.condition.policies.empty();
        condition.knows_truth = prediction::knows_truth(one.condition.predictor);
        condition.idle_parts = one.idle_parts;
        condition.leases = one.leases;
        condition.emergency = endings_from(one.emergency);
        condition.others = endings_from(one.others);
        condition.runs = one.complete_runs;
        condition.missing_runs = one.missing_runs;
        const analysis::ConditionSummary* const baseline =
            one.baseline.empty() ? nullptr : summary.find(one.baseline);
        if (baseline != nullptr) {
            condition.baseline = static_cast<std::size_t>(baseline - summary.conditions.data());
        }
        fill_outcomes(one, baseline, level, condition);
        for (const MeasureInfo& measure : measures()) {
            if (measure.relevance == Relevance::least)
                condition.outcome(measure.measure).least_relevant = least_relevant_s;
        }
        condition.travel_time_median = estimate_from(one.travel_time.median, one.complete_runs);
        condition.travel_time_percentile_95 = estimate_from(one.travel_time.percentile_95, one.complete_runs);
        fill_response(one.response, condition);
        facts.response_threshold_s = one.response.threshold_s;
        condition.events = events_of(one);
        condition.safety = detail::safety_of(one);
        fill_pairs(one, level, least_relevant_s, condition);
        fill_traffic(one, condition);
        facts.conditions.push_back(std::move(condition));
    }
    return facts;
}

Distribution distribution_of(std::vector<double> seconds, std::uint64_t all) {
    Distribution distribution;
    distribution.arrived = seconds.size();
    distribution.all = all;
    std::sort(seconds.begin(), seconds.end());
    const std::size_t points = std::min(seconds.size(), distribution_points);
    for (std::size_t point = 1; point <= points; ++point) {
        const std::size_t rank = point * seconds.size() / points;  // the last point is the last value
        distribution.points.push_back(
            {seconds[rank - 1],
             static_cast<double>(rank) / static_cast<double>(std::max<std::uint64_t>(all, 1))});
    }
    return distribution;
}

void add_distributions(const results::Results& results, std::map<ConditionKey, ConditionFacts*>& conditions) {
    std::map<ConditionKey, std::pair<std::vector<double>, std::uint64_t>> times;
    for (const results::RunRecord& run : results.runs) {
        auto& [seconds, all] = times[{run.key.scenario, run.key.condition}];
        for (const metrics::VehicleRow& vehicle : run.vehicles) {
            if (vehicle.vehicle_class != traffic::VehicleClass::emergency) continue;
            ++all;
            if (vehicle.outcome == metrics::VehicleOutcome::arrived && vehicle.travel_time_s) {
                seconds.push_back(*vehicle.travel_time_s);
            }
        }
    }
    for (auto& [key, entry] : times) {
        const auto found = conditions.find(key);
        if (found != conditions.end()) {
            found->second->travel_time = distribution_of(std::move(entry.first), entry.second);
        }
    }
}

/// What the emergency vehicles of a scenario are called: by their kind where all are of one.
void add_nouns(const results::Results& results, StudyFacts& study) {
    static const std::map<traffic::VehicleKind, const char*> plurals = {
        {traffic::VehicleKind::ambulance, "ambulances"},
        {traffic::VehicleKind::fire_engine, "fire engines"},
        {traffic::VehicleKind::police_car, "police cars"}};
    std::map<std::string, std::set<traffic::VehicleKind>> kinds;
    for (const results::RunRecord& run : results.runs) {
        for (const metrics::VehicleRow& vehicle : run.vehicles) {
            if (vehicle.vehicle_class == traffic::VehicleClass::emergency)
                kinds[run.key.scenario].insert(vehicle.kind);
        }
    }
    for (ScenarioFacts& scenario : study.scenarios) {
        const std::set<traffic::VehicleKind>& seen = kinds[scenario.name];
        const auto plural = seen.size() == 1 ? plurals.find(*seen.begin()) : plurals.end();
        if (plural != plurals.end()) scenario.emergency_noun = plural->second;
    }
}

void add_errors(const results::Results& results, std::map<ConditionKey, ConditionFacts*>& conditions) {
    for (const results::RunError& error : results.errors) {
        const auto found = conditions.find({error.key.scenario, error.key.condition});
        if (found == conditions.end()) continue;
        std::string cause = fmt::format("{}: {}", results::name(error.cause), error.message);
        if (error.signal != 0) cause += fmt::format(" (signal {})", error.signal);
        if (error.attempts > 1) cause += fmt::format(", {} attempts", error.attempts);
        found->second->failed.push_back({error.key.replication, std::move(cause)});
    }
}

std::vector<LossCurve> curves_in(const fs::path& folder) {
    std::set<fs::path> trainings;
    if (fs::is_directory(folder)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            if (fs::exists(entry.path() / "losses.csv")) trainings.insert(entry.path());
        }
    }
    std::vector<LossCurve> curves;
    curves.reserve(trainings.size());
    for (const fs::path& training : trainings) {
        curves.push_back(read_losses(training));
    }
    return curves;
}

std::vector<Provenance> provenance_of(const results::Results& results) {
    const results::Manifest& manifest = results.manifest;
    std::vector<Provenance> rows = {
        {"Study", manifest.study},
        {"Clearway", manifest.clearway_version},
        {"SUMO", manifest.sumo_version},
        {"Study seed", std::to_string(manifest.study_seed)},
        {"Replications", manifest.replications == 0 ? std::string("none")
                                                    : fmt::format("0 to {}", manifest.replications - 1)},
        {"Hash of the manifest", results::manifest_hash(manifest)}};
    for (const results::ScenarioEntry& scenario : manifest.scenarios) {
        rows.emplace_back(
            fmt::format("Scenario {}", scenario.name),
            fmt::format("{}; configuration and files {}", scenario.version, scenario.configuration_hash));
    }
    rows.emplace_back("Runs", fmt::format("{} complete, {} failed, {} missing", grouped(results.runs.size()),
                                          grouped(results.errors.size()), grouped(results.missing.size())));
    return rows;
}

std::optional<std::vector<WideEdge>> wide_edges_in(const fs::path& file) {
    if (!fs::exists(file)) return std::nullopt;
    try {
        std::vector<WideEdge> edges;
        for (const nlohmann::json& row : nlohmann::json::parse(core::read_file(file))) {
            edges.push_back({row.at("edge").get<std::string>(), row.at("street").get<std::string>(),
                             row.at("car_lanes").get<int>()});
        }
        return edges;
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError(core::Problem{file.string(), error.what(),
                                             "a list of objects with edge, street and car_lanes",
                                             "Remove the file, or create the run folder again"});
    }
}

/// Of a stored scenario.toml; 0 if it does not say.
double step_length_in(const std::string& configuration) {
    return core::parse_toml(configuration, "manifest.json")["time"]["step_length_s"].value_or(0.0);
}

void add_files(const results::Manifest& manifest, const fs::path& folder, StudyFacts& study) {
    for (ScenarioFacts& scenario : study.scenarios) {
        const fs::path picture = folder / "scenarios" / scenario.name / "network.svg";
        if (fs::exists(picture)) {
            const std::string svg = core::read_file(picture);
            if (is_safe_picture(svg)) scenario.network_svg = svg.substr(svg.find("<svg"));
        }
        const auto streets = detail::streets_in(folder / "scenarios" / scenario.name / "streets.json");
        for (ConditionFacts& condition : scenario.conditions) {
            for (ApproachFacts& approach : condition.approaches) {
                if (const auto found = streets.find(approach.edge); found != streets.end())
                    approach.street = found->second;
            }
        }
        scenario.wide_edges = wide_edges_in(folder / "scenarios" / scenario.name / "wide_edges.json");
        for (const results::ScenarioEntry& entry : manifest.scenarios) {
            if (entry.name != scenario.name) continue;
            scenario.attribution = entry.attribution;
            scenario.step_length_s = step_length_in(entry.configuration);
        }
    }
    study.curves = curves_in(folder / "training");
    const fs::path command = folder / "command.txt";
    if (fs::exists(command)) study.command = core::read_file(command);
}

}  // namespace

StudyFacts facts_of(const results::Results& results, const analysis::Summary& summary, const fs::path& folder,
                    double least_relevant_s) {
    StudyFacts study;
    study.title = fmt::format("Clearway: {}", summary.manifest.study);
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        study.scenarios.push_back(
            scenario_facts(scenario, summary.manifest, summary.level, least_relevant_s));
    }
    std::map<ConditionKey, ConditionFacts*> conditions;
    for (ScenarioFacts& scenario : study.scenarios) {
        for (ConditionFacts& condition : scenario.conditions) {
            conditions[{scenario.name, condition.name}] = &condition;
        }
    }
    add_distributions(results, conditions);
    add_nouns(results, study);
    add_errors(results, conditions);
    add_files(summary.manifest, folder, study);
    study.plan = summary.manifest.plan;
    study.planned = analysis::planned_findings(summary);
    study.failure_curves = failure_curves(summary);
    study.sensitivities = sensitivities(summary);
    const results::Store store = results::Store::open(folder);
    for (ScenarioFacts& scenario : study.scenarios)
        scenario.journeys = detail::journeys_in(store, scenario);
    for (ScenarioFacts& scenario : study.scenarios) {
        auto roads = detail::roads_in(store.scenario_folder(scenario.name) / "roads.json");
        if (!roads) continue;
        scenario.signals = roads->signals.size();
        scenario.map = detail::map_in(store, study, scenario, std::move(*roads));
    }
    for (ScenarioFacts& scenario : study.scenarios) {
        if (scenario.conditions.empty()) continue;
        const fs::path home = folder / "scenarios" / scenario.name;
        scenario.flows =
            detail::flows_in(home / "counts.csv", results, scenario.name, scenario.conditions.front().name);
        const auto streets = detail::streets_in(home / "streets.json");
        for (FlowFacts& flow : scenario.flows) {
            if (const auto found = streets.find(flow.edge); found != streets.end())
                flow.street = found->second;
        }
    }
    study.provenance = provenance_of(results);
    return study;
}

StudyFacts read_facts(const fs::path& folder, double least_relevant_s) {
    const results::Store store = results::Store::open(folder);
    const results::Results results = results::read_results(store, results::VehicleRows::emergency);
    return facts_of(results, analysis::summarise(results), folder, least_relevant_s);
}

}  // namespace clearway::report
