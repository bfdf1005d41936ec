#include "report/read_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/estimate.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

namespace fs = std::filesystem;
using ConditionKey = std::pair<std::string, std::string>;  // scenario, condition

/// The dissertation's names for its three conditions, and ours for the controls beside them.
std::string title_of(const std::string& condition) {
    static const std::map<std::string, std::string> titles = {
        {"baseline", "Baseline"},
        {"graph_simulation", "Graph made by simulation attributes"},
        {"graph_graphsage", "Graph made by GraphSAGE"},
        {"b10_no_repair", "Same failures, no repair"},
        {"b10_dead_reckoning", "Same failures, dead reckoning"},
        {"solo", "Alone on the road, signals open"},
    };
    const auto found = titles.find(condition);
    return found == titles.end() ? condition : found->second;
}

std::string recipe_of(const results::ConditionSpec& condition) {
    return fmt::format(
        "sensing {}; repair {}; policy {}; engine {}; safety checks {}", condition.failure,
        condition.predictor,
        condition.parts.empty() ? "none" : fmt::format("{}", fmt::join(condition.parts, " + ")),
        results::name(condition.engine), condition.safety_checks == traffic::SafetyChecks::on ? "on" : "off");
}

Estimate estimate_from(const std::optional<analysis::Estimate>& estimate) {
    if (!estimate) return {};
    Estimate result{estimate->mean, std::nullopt, std::nullopt, estimate->n};
    if (estimate->interval) {
        result.low = estimate->interval->low;
        result.high = estimate->interval->high;
    }
    return result;
}

Endings endings_from(const analysis::OutcomeCounts& counts) {
    return {counts.arrived, counts.running_at_end, counts.teleported, counts.not_inserted, counts.removed};
}

using Values = std::vector<std::optional<double>>;

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

Estimate mean_of(const Values& values, double level) {
    std::vector<double> present;
    for (const auto& value : values) {
        if (value) present.push_back(*value);
    }
    return estimate_from(analysis::estimate_mean(present, level));
}

Estimate difference_of(const Values& condition, const Values& baseline, double level) {
    std::vector<double> with;
    std::vector<double> without;
    for (std::size_t row = 0; row < std::min(condition.size(), baseline.size()); ++row) {
        if (!condition[row] || !baseline[row]) continue;
        with.push_back(*condition[row]);
        without.push_back(*baseline[row]);
    }
    return estimate_from(analysis::estimate_difference(with, without, level));
}

/// Fills every measure that the summary holds under the name of its field.
void fill_outcomes(const analysis::ConditionSummary& summary, const analysis::ConditionSummary* baseline,
                   double level, ConditionFacts& facts) {
    for (const MeasureInfo& measure : measures()) {
        Outcome& outcome = facts.outcome(measure.measure);
        if (measure.measure == Measure::gap_closed) {
            if (!summary.gap_closed) continue;
            outcome.value = {summary.gap_closed->value, std::nullopt, std::nullopt, summary.gap_replications};
            if (summary.gap_closed->interval) {
                outcome.value.low = summary.gap_closed->interval->low;
                outcome.value.high = summary.gap_closed->interval->high;
            }
        } else if (measure.measure == Measure::unfinished) {
            const Values values = not_arrived(summary);
            outcome.value = mean_of(values, level);
            if (baseline != nullptr)
                outcome.difference = difference_of(values, not_arrived(*baseline), level);
        } else {
            const analysis::MetricSummary& metric = summary.metric(measure.field);
            outcome.value = estimate_from(metric.estimate);
            if (metric.comparison) outcome.difference = estimate_from(metric.comparison->difference);
        }
    }
}

ScenarioFacts scenario_facts(const analysis::ScenarioSummary& summary, const results::Manifest& manifest,
                             double level) {
    ScenarioFacts facts;
    facts.name = summary.scenario;
    facts.title = summary.title;
    facts.replications = manifest.replications;
    for (const analysis::ConditionSummary& one : summary.conditions) {
        ConditionFacts condition;
        condition.name = one.condition.name;
        condition.title = title_of(condition.name);
        condition.recipe = recipe_of(one.condition);
        condition.safety_checks_off = one.condition.safety_checks == traffic::SafetyChecks::off;
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

void add_failures(const results::Results& results, std::map<ConditionKey, ConditionFacts*>& conditions) {
    for (const results::FailureRecord& failure : results.failures) {
        const auto found = conditions.find({failure.key.scenario, failure.key.condition});
        if (found == conditions.end()) continue;
        std::string cause = fmt::format("{}: {}", results::name(failure.cause), failure.message);
        if (failure.signal != 0) cause += fmt::format(" (signal {})", failure.signal);
        if (failure.attempts > 1) cause += fmt::format(", {} attempts", failure.attempts);
        found->second->failed.push_back({failure.key.replication, std::move(cause)});
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
            fmt::format("{}; effective configuration {}", scenario.version, scenario.configuration_hash));
    }
    rows.emplace_back("Runs", fmt::format("{} complete, {} failed, {} missing", grouped(results.runs.size()),
                                          grouped(results.failures.size()), grouped(results.missing.size())));
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
                                             "Remove the file, or make the run folder again"});
    }
}

void add_files(const results::Manifest& manifest, const fs::path& folder, StudyFacts& study) {
    for (ScenarioFacts& scenario : study.scenarios) {
        const fs::path picture = folder / "scenarios" / scenario.name / "network.svg";
        if (fs::exists(picture)) {
            const std::string svg = core::read_file(picture);
            if (is_safe_picture(svg)) scenario.network_svg = svg.substr(svg.find("<svg"));
        }
        scenario.wide_edges = wide_edges_in(folder / "scenarios" / scenario.name / "wide_edges.json");
        for (const results::ScenarioEntry& entry : manifest.scenarios) {
            if (entry.name == scenario.name) scenario.attribution = entry.attribution;
        }
    }
    study.curves = curves_in(folder / "training");
    const fs::path command = folder / "command.txt";
    if (fs::exists(command)) study.command = core::read_file(command);
}

}  // namespace

StudyFacts facts_of(const results::Results& results, const analysis::Summary& summary,
                    const fs::path& folder) {
    StudyFacts study;
    study.title = fmt::format("Clearway: {}", summary.manifest.study);
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        study.scenarios.push_back(scenario_facts(scenario, summary.manifest, summary.level));
    }
    std::map<ConditionKey, ConditionFacts*> conditions;
    for (ScenarioFacts& scenario : study.scenarios) {
        for (ConditionFacts& condition : scenario.conditions) {
            conditions[{scenario.name, condition.name}] = &condition;
        }
    }
    add_distributions(results, conditions);
    add_failures(results, conditions);
    add_files(summary.manifest, folder, study);
    study.failure_curves = failure_curves(summary);
    study.provenance = provenance_of(results);
    return study;
}

StudyFacts read_facts(const fs::path& folder) {
    const results::Store store = results::Store::open(folder);
    const results::Results results = results::read_results(store);
    return facts_of(results, analysis::summarise(results), folder);
}

}  // namespace clearway::report
