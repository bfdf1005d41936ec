#include "report/read_facts.hpp"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/estimate.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "experiment/settings.hpp"
#include "prediction/predictor.hpp"
#include "report/configuration.hpp"
#include "report/detail/aspects.hpp"
#include "report/detail/map_facts.hpp"
#include "report/detail/side_files.hpp"
#include "report/detail/traffic_facts.hpp"
#include "report/detail/trip_facts.hpp"
#include "report/text.hpp"
#include "results/factor_columns.hpp"

namespace clearway::report {
namespace {

namespace fs = std::filesystem;

/// The scenario of the dissertation whose table is shown beside a scenario of its study.
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

using analysis::Values;

/// Vehicles that did not arrive, by replication: the sum of three metrics.
Values not_arrived(const analysis::ConditionSummary& condition) {
    Values total = condition.metric("unfinished").values;
    for (const char* const name : {"not_inserted", "removed"}) {
        const Values& values = condition.metric(name).values;
        for (std::size_t row = 0; row < values.size(); ++row)
            total[row] = total[row] && values[row] ? std::optional(*total[row] + *values[row]) : std::nullopt;
    }
    return total;
}

/// Adds the measures that no run holds as a metric of its own.
void add_derived(const analysis::ConditionSummary* baseline, double level, ConditionFacts& facts) {
    analysis::MetricSummary gap;
    gap.metric.name = info(Measure::gap_closed).field;
    // An EV that did not arrive counts with the horizon, so the share would be a large negative number.
    if (!facts.objections.loses_emergency()) gap.estimate = facts.gap_closed;
    analysis::MetricSummary unfinished;
    unfinished.metric.name = info(Measure::unfinished).field;
    const auto kind = unfinished.metric.kind = analysis::MetricKind::count;
    unfinished.values = not_arrived(facts);
    unfinished.estimate = analysis::estimate_values(unfinished.values, kind, level);
    if (baseline != nullptr)
        unfinished.comparison.emplace().difference =
            analysis::estimate_paired(unfinished.values, not_arrived(*baseline), kind, level);
    facts.metrics.push_back(std::move(gap));
    facts.metrics.push_back(std::move(unfinished));
}

/// Half widths as replications were added. Means and sums of squares by Welford 1962.
std::optional<Precision> precision_of(const std::optional<analysis::Comparison>& comparison, double level,
                                      double least_relevant_s) {
    constexpr std::size_t first_drawn = 5;  // with fewer, large t quantiles would dwarf the rest of the curve
    if (!comparison || comparison->complete_pairs < 2) return std::nullopt;
    Precision precision;
    const std::size_t pairs = comparison->complete_pairs;
    const std::size_t stride = pairs / precision_points + 1;
    double mean = 0.0;
    double squares = 0.0;
    for (std::size_t n = 1; n <= pairs; ++n) {
        const double difference = comparison->condition_values[n - 1] - comparison->baseline_values[n - 1];
        const double before = difference - mean;
        mean += before / static_cast<double>(n);
        squares += before * (difference - mean);
        if (n < 2) continue;
        precision.deviation_s = std::sqrt(squares / static_cast<double>(n - 1));
        if (n >= first_drawn && ((pairs - n) % stride == 0))
            precision.points.push_back({n, analysis::half_width(precision.deviation_s, n, level)});
    }
    const double wanted_s = least_relevant_s > 0.0 ? least_relevant_s : usual_least_relevant_s;
    precision.needed = analysis::advised_replications(precision.deviation_s, wanted_s, level);
    if (comparison->unlocked && comparison->unlocked->n >= 2)
        precision.needed_unlocked =
            analysis::advised_replications(comparison->unlocked->deviation, wanted_s, level);
    return precision;
}

ConditionFacts condition_facts(const analysis::ConditionSummary& summary,
                               const analysis::ScenarioSummary& scenario, double level,
                               double least_relevant_s) {
    ConditionFacts facts;
    static_cast<analysis::ConditionSummary&>(facts) = summary;
    facts.recipe = recipe_of(facts.condition);
    facts.knows_truth = prediction::knows_truth(facts.condition.predictor);
    facts.least_relevant_s = least_relevant_s;
    facts.precision =
        precision_of(facts.metric(analysis::primary_metric).comparison, level, least_relevant_s);
    add_derived(scenario.find(facts.baseline), level, facts);
    return facts;
}

ScenarioFacts scenario_facts(const analysis::ScenarioSummary& summary, const analysis::Summary& study,
                             double least_relevant_s) {
    ScenarioFacts facts;
    facts.name = summary.scenario;
    if (study.manifest.study == "dissertation" || study.manifest.study == "dissertation-quick")
        facts.published_as = published_scenario(summary.scenario);
    facts.title = summary.title;
    facts.replications = study.manifest.replications;
    facts.least_relevant_s = least_relevant_s;
    const results::FactorColumns factors(study.manifest);
    for (const analysis::ConditionSummary& one : summary.conditions) {
        ConditionFacts& condition =
            facts.conditions.emplace_back(condition_facts(one, summary, study.level, least_relevant_s));
        condition.factors = factors.settings(summary.scenario, condition.name());
        facts.response_threshold_s = one.response.threshold_s;
    }
    return facts;
}

using Conditions = std::map<std::pair<std::string, std::string>, ConditionFacts*>;  // by scenario, name

/// The condition of a run; nullptr if the study does not name it.
ConditionFacts* find(const Conditions& conditions, const experiment::RunKey& key) {
    const auto found = conditions.find({key.scenario, key.condition});
    return found == conditions.end() ? nullptr : found->second;
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

void add_errors(const results::Results& results, const Conditions& conditions) {
    for (const results::RunError& error : results.errors) {
        ConditionFacts* const condition = find(conditions, error.key);
        if (condition == nullptr) continue;
        std::string cause = fmt::format("{}: {}", results::name(error.cause), error.message);
        if (error.signal != 0) cause += fmt::format(" (signal {})", error.signal);
        if (error.attempts > 1) cause += fmt::format(", {} attempts", error.attempts);
        condition->failed.push_back({error.key.replication, std::move(cause)});
    }
}

std::vector<LossCurve> curves_in(const fs::path& folder) {
    std::set<fs::path> trainings;
    if (fs::is_directory(folder)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            std::error_code unknown;
            if (fs::exists(entry.path() / "losses.csv", unknown)) trainings.insert(entry.path());
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
        {"Build", manifest.clearway_build},
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

/// What lies beside a scenario's runs, each file read once.
void add_files(const results::Store& store, const results::Results& results, ScenarioFacts& scenario) {
    const fs::path home = store.scenario_folder(scenario.name);
    if (fs::exists(home / "network.svg")) {
        const std::string svg = core::read_file(home / "network.svg");
        if (is_safe_picture(svg)) scenario.network_svg = svg.substr(svg.find("<svg"));
    }
    scenario.wide_edges = detail::wide_edges_in(home / "wide_edges.json");
    scenario.streets = detail::streets_in(home / "streets.json");
    scenario.outlook = detail::outlook_in(home / "outlook.json");
    scenario.roads = detail::roads_in(home / "roads.json");
    if (!scenario.conditions.empty())
        scenario.flows = detail::flows_in(home / "counts.csv", results, scenario);
    for (const results::ScenarioEntry& entry : results.manifest.scenarios) {
        if (entry.name != scenario.name) continue;
        scenario.attribution = entry.attribution;
        scenario.variant = entry.variant;
        add_configuration(entry.configuration, scenario);
    }
}

void choose(const std::string& chosen, StudyFacts& study) {
    bool is_compared = chosen.empty();
    for (ScenarioFacts& scenario : study.scenarios) {
        scenario.chosen = chosen;
        const std::size_t place = scenario.place_of(chosen);
        is_compared =
            is_compared || (place < scenario.conditions.size() && scenario.conditions[place].is_compared());
    }
    if (!is_compared)
        throw core::InputError({"--condition", fmt::format("`{}` is compared with nothing here", chosen),
                                "a condition that is compared with another", "Choose another"});
}

/// As analysis::to_text, with titles in place of names and levels.
std::string titled(analysis::Reference reference, const std::vector<ConditionFacts>& conditions) {
    const analysis::Reference by_name = reference;
    for (const ConditionFacts& condition : conditions) {
        if (condition.name() == by_name.name) reference.name = condition.title;
        for (auto& [factor, level] : reference.levels) {
            const auto value = condition.condition.factors.find(factor);
            const auto title = condition.factor_titles.find(factor);
            if (value != condition.condition.factors.end() && value->second == by_name.levels.at(factor) &&
                title != condition.factor_titles.end())
                level = title->second;
        }
    }
    return analysis::to_text(reference);
}

}  // namespace

Titles titles_of(const results::Store& store, const analysis::Summary& summary,
                 const analysis::Reference& reference) {
    const experiment::ConditionTitles titles(given_titles_of(store));
    Titles found;
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        std::vector<ConditionFacts> conditions;
        for (const analysis::ConditionSummary& condition : scenario.conditions)
            conditions.emplace_back().condition = condition.condition;
        detail::give_titles(titles, conditions);
        for (const ConditionFacts& condition : conditions)
            found.conditions[{scenario.scenario, condition.name()}] = condition.title;
        found.reference = titled(reference, conditions);
    }
    return found;
}

core::Settings titles_of(const results::Store& store) {
    return experiment::ConditionTitles(given_titles_of(store)).of(store.manifest().conditions);
}

core::Settings given_titles_of(const results::Store& store) {
    return detail::titles_in(store.folder() / "titles.json");
}

StudyFacts facts_of(const results::Store& store, const results::Results& results,
                    const analysis::Summary& summary, double least_relevant_s, const std::string& chosen) {
    StudyFacts study;
    study.title = fmt::format("Clearway: {}", summary.manifest.study);
    for (const analysis::ScenarioSummary& scenario : summary.scenarios)
        study.scenarios.push_back(scenario_facts(scenario, summary, least_relevant_s));
    choose(chosen, study);
    Conditions conditions;
    const experiment::ConditionTitles titles(given_titles_of(store));
    for (ScenarioFacts& scenario : study.scenarios) {
        detail::give_titles(titles, scenario.conditions);
        for (ConditionFacts& condition : scenario.conditions)
            conditions[{scenario.name, condition.name()}] = &condition;
    }
    const core::Settings controls = detail::controls_in(store.folder() / "controls.json");
    for (const auto& [key, condition] : conditions)
        if (const auto of = controls.find(key.second); of != controls.end())
            condition->control_of = of->second;
    for (ScenarioFacts& scenario : study.scenarios)
        detail::add_trips(results, scenario);
    add_nouns(results, study);
    add_errors(results, conditions);
    study.plan = summary.manifest.plan;
    study.planned = analysis::planned_findings(summary);
    study.failure_curves = failure_curves(summary);
    study.sensitivities = sensitivities(summary, controls);
    for (ScenarioFacts& scenario : study.scenarios) {
        add_files(store, results, scenario);
        detail::RunTraffic traffic(store);
        scenario.journeys = detail::journeys_in(traffic, study, scenario);
        scenario.map = detail::map_in(traffic, study, scenario);
    }
    study.curves = curves_in(store.folder() / "training");
    const fs::path command = store.folder() / "command.txt";
    if (fs::exists(command)) study.command = core::read_file(command);
    const fs::path file = store.folder() / "study.toml";
    if (fs::exists(file)) study.study_file = core::read_file(file);
    study.provenance = provenance_of(results);
    return study;
}

StudyFacts read_facts(const fs::path& folder, double least_relevant_s, const analysis::Reference& reference,
                      const std::string& chosen) {
    const results::Store store = results::Store::open(folder);
    const results::Results results = results::read_results(store, results::VehicleRows::emergency);
    const analysis::Summary summary = analysis::summarise(results, analysis::usual_level, {}, reference);
    StudyFacts facts = facts_of(store, results, summary, least_relevant_s, chosen);
    if (!facts.scenarios.empty()) facts.reference = titled(reference, facts.scenarios[0].conditions);
    return facts;
}

}  // namespace clearway::report
