#include "study/plan.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/folder_name.hpp"
#include "core/own_output.hpp"
#include "core/part_folder.hpp"
#include "core/plain_files.hpp"
#include "core/read_failure.hpp"
#include "experiment/condition_titles.hpp"
#include "experiment/conditions.hpp"
#include "experiment/related_conditions.hpp"
#include "scenario/network.hpp"
#include "study/detail/situation.hpp"
#include "study/folder_lock.hpp"

namespace clearway::study {
namespace {

namespace fs = std::filesystem;
using experiment::TrafficModel;

constexpr const char* network_name = "network";
constexpr const char* scenario_file_name = "scenario.toml";

void check_name(const std::string& what, const std::string& name, std::set<std::string>& seen,
                std::vector<core::Problem>& problems, const char* cure = "Rename one") {
    core::check_folder_name(what, name, problems);
    if (!seen.insert(name).second)
        problems.push_back({what, fmt::format("\"{}\" is used twice", name), "each name once", cure});
}

void check_condition_name(const experiment::ConditionSpec& condition, std::set<std::string>& seen,
                          std::vector<core::Problem>& problems) {
    check_name("condition", condition.name, seen, problems);
    if (experiment::takes_built_in_name(condition))
        problems.push_back(
            {"condition",
             fmt::format("\"{}\" is the name of a built-in condition, and this is another", condition.name),
             "any other name", "Rename it"});
}

void check_baselines(const StudyConfig& config, std::vector<core::Problem>& problems) {
    constexpr std::size_t most_named = 2;
    const core::Settings titles = experiment::ConditionTitles(config.titles).of(config.conditions);
    std::map<TrafficModel, std::vector<std::string>> alone;
    for (const experiment::ConditionSpec& condition : config.conditions) {
        if (condition.traffic_model == TrafficModel::free_flow || !condition.acts()) continue;
        const auto is_baseline = [&](const experiment::ConditionSpec& other) {
            return !other.acts() && experiment::same_environment(other, condition);
        };
        if (!std::ranges::any_of(config.conditions, is_baseline))
            alone[condition.traffic_model].push_back(titles.at(condition.name));
    }
    for (auto& [model, names] : alone) {
        const std::size_t more = names.size() - std::min(names.size(), most_named);
        names.resize(names.size() - more);
        problems.push_back({fmt::format("condition {}{}", fmt::join(names, "; "),
                                        more > 0 ? fmt::format("; and {} more", more) : ""),
                            fmt::format("has no baseline with traffic model \"{}\"", experiment::name(model)),
                            "a condition with the same traffic model and without policies",
                            model == TrafficModel::standard ? "Add \"baseline\" to the conditions"
                                                            : "Add one with [[condition]]"});
    }
}

void check(const StudyConfig& config) {
    std::vector<core::Problem> problems;
    if (config.scenarios.empty()) problems.push_back({"study", "has no scenario", "", "Name at least one"});
    if (config.conditions.empty()) problems.push_back({"study", "has no condition", "", "Name at least one"});
    const std::uint64_t runs =
        results::runs_of(config.scenarios.size(), config.conditions.size(), config.replications);
    if (runs > config.most_runs)
        problems.push_back(
            {"study",
             fmt::format("has {} scenarios x {} conditions x {} replications, {} runs",
                         config.scenarios.size(), config.conditions.size(), config.replications, runs),
             fmt::format("at most {} runs", config.most_runs),
             "Take fewer; run, study and study submit allow more with --most-runs"});
    if (config.replications == 0) problems.push_back({"replications", "0 is out of range", "1 or more", ""});
    std::set<std::string> studies;
    const bool is_of_scenario = config.scenarios.size() == 1 && config.scenarios.front().name == config.name;
    if (!is_of_scenario) check_name("study", config.name, studies, problems);
    std::set<std::string> scenarios;
    for (const scenario::ScenarioConfig& scenario : config.scenarios)
        check_name("scenario", scenario.name, scenarios, problems,
                   "Change `name` in the scenario.toml of one (a copied folder keeps `name`), or name one in "
                   "[[scenario]]");
    std::set<std::string> conditions;
    for (const experiment::ConditionSpec& condition : config.conditions)
        check_condition_name(condition, conditions, problems);
    check_baselines(config, problems);
    for (const scenario::ScenarioConfig& scenario : config.scenarios) {
        for (const experiment::ConditionSpec& condition : config.conditions)
            detail::check_traffic_model(condition, scenario, problems);
    }
    if (!problems.empty()) throw core::InputError(problems);
}

/// Stores a scenario and its network atomically.
void prepare_scenario(const scenario::ScenarioConfig& config, const fs::path& target) try {
    if (fs::exists(target)) return;
    core::PartFolder part(target);
    scenario::store(config, part.path());
    scenario::build_network(config, part.path() / network_name);
    part.replace();
} catch (const fs::filesystem_error& error) {
    throw core::EnvironmentError(
        fmt::format("{}: {}. {}", target.string(), error.what(), core::cure_of(error.code().value())));
}

}  // namespace

std::size_t Plan::run_count() const {
    std::size_t count = 0;
    for (const PlannedUnit& planned : units)
        count += planned.unit.conditions.size();
    return count;
}

StudyConfig baselines_of(StudyConfig config, std::uint32_t replications) {
    config.name += "-baselines";
    config.replications = replications;
    std::erase_if(config.conditions, [](const experiment::ConditionSpec& condition) {
        return condition.acts() || condition.traffic_model == experiment::TrafficModel::free_flow;
    });
    config.titles.clear();
    config.doubtful_titles.clear();
    config.controls.clear();
    config.precision.reset();
    config.plan.reset();
    return config;
}

results::Manifest manifest_of(const StudyConfig& config, const Versions& versions) {
    results::Manifest manifest;
    manifest.study = config.name;
    manifest.clearway_version = versions.clearway;
    manifest.sumo_version = versions.sumo;
    manifest.clearway_build = versions.build;
    manifest.study_seed = config.seed;
    manifest.replications = config.replications;
    for (const scenario::ScenarioConfig& scenario : config.scenarios) {
        const auto factors = config.scenario_factors.find(scenario.name);
        manifest.scenarios.push_back(
            {scenario.name, scenario.version, scenario.title, scenario::to_toml(scenario),
             scenario::scenario_hash(scenario), scenario.network.attribution,
             factors == config.scenario_factors.end() ? core::Settings{} : factors->second,
             scenario.variant == scenario::Variant::standard ? ""
                                                             : std::string(core::name(scenario.variant))});
    }
    manifest.conditions = config.conditions;
    manifest.precision = config.precision;
    manifest.plan = config.plan;
    return manifest;
}

Plan make_plan(const StudyConfig& config, const Versions& versions, const fs::path& folder) {
    check(config);
    Plan plan;
    plan.manifest = manifest_of(config, versions);
    plan.scenarios = config.scenarios;
    plan.titles = config.titles;
    plan.controls = config.controls;
    plan.text = config.text;
    const fs::path output = fs::absolute(folder);
    for (const UnitPlace& place : units_of(plan.manifest)) {
        experiment::RunJob unit;
        unit.scenario = plan.manifest.scenarios[place.scenario].name;
        unit.scenario_file = output / "scenarios" / unit.scenario / scenario_file_name;
        unit.network_folder = output / "scenarios" / unit.scenario / network_name;
        unit.study_seed = config.seed;
        unit.replication = place.replication;
        unit.traffic_model = place.process.traffic_model;
        std::ranges::copy_if(
            config.conditions, std::back_inserter(unit.conditions),
            [&](const auto& condition) { return experiment::process_of(condition) == place.process; });
        unit.output = output;
        const std::string name =
            fmt::format("{}-{:05}-{}", unit.scenario, unit.replication, experiment::to_text(place.process));
        plan.units.push_back({name, std::move(unit)});
    }
    return plan;
}

std::vector<UnitPlace> units_of(const results::Manifest& manifest) {
    std::vector<experiment::ProcessOptions> processes;
    for (const TrafficModel traffic_model :
         {TrafficModel::standard, TrafficModel::sublane, TrafficModel::free_flow}) {
        for (const experiment::ConditionSpec& condition : manifest.conditions) {
            const experiment::ProcessOptions process = experiment::process_of(condition);
            if (process.traffic_model == traffic_model && !core::contains(processes, process))
                processes.push_back(process);
        }
    }
    std::vector<UnitPlace> places;
    for (std::uint32_t replication = 0; replication < manifest.replications; ++replication) {
        for (std::size_t scenario = 0; scenario < manifest.scenarios.size(); ++scenario) {
            for (const experiment::ProcessOptions& process : processes)
                places.push_back({scenario, replication, process});
        }
    }
    return places;
}

void check_roads(const Plan& plan) {
    std::vector<core::Problem> problems;
    for (const scenario::ScenarioConfig& config : plan.scenarios) {
        detail::check_mean_times(plan.manifest.conditions, config, plan.manifest.study_seed, problems);
        detail::check_roads(plan.manifest.conditions, config, problems);
    }
    detail::check_calls(plan.manifest.conditions, plan.scenarios, problems);
    if (!problems.empty()) throw core::InputError(problems);
}

void require_unchanged(const results::ScenarioEntry& entry, const fs::path& folder) {
    const fs::path file = folder / scenario_file_name;
    if (scenario::scenario_hash(scenario::load(file.string())) != entry.configuration_hash)
        throw core::InputError({file.string(), "was changed, or a file beside it, since the study began", "",
                                fmt::format("Put it back, or remove {}: it is made again", folder.string())});
    scenario::require_unchanged_network(folder / network_name);
}

void require_unchanged(const results::Store& store) {
    for (const results::ScenarioEntry& entry : store.manifest().scenarios) {
        const fs::path folder = store.scenario_folder(entry.name);
        if (fs::exists(folder)) require_unchanged(entry, folder);
    }
}

void require_ready(const Plan& plan, const fs::path& folder) {
    check_roads(plan);
    if (fs::exists(folder / "manifest.json")) core::require_plain_files(folder);
    core::require_writable(folder);
}

results::Store prepare_folder(const Plan& plan, const fs::path& folder) {
    require_ready(plan, folder);
    results::Store::require_fits(folder, plan.manifest, plan.titles);
    const FolderLock lock(folder);
    results::Store store = results::Store::create(folder, plan.manifest);
    require_unchanged(store);
    for (const scenario::ScenarioConfig& config : plan.scenarios)
        prepare_scenario(config, store.scenario_folder(config.name));
    return store;
}

}  // namespace clearway::study
