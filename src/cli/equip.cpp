#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/equipment.hpp"
#include "campaign/equip_rounds.hpp"
#include "campaign/run_plan.hpp"
#include "cli/detail/chosen_conditions.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/files.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "policy/policy.hpp"
#include "python/part_name.hpp"
#include "report/equipment.hpp"
#include "scenario/network.hpp"
#include "scenario/picture.hpp"

namespace clearway::cli {
namespace {

constexpr std::uint32_t usual_seeds = 10;  // FHWA's minimum number of replications
constexpr std::size_t most_signals = 10000;

struct Arguments {
    std::string scenario;
    std::size_t budget = 1;
    ConditionWords conditions;
    analysis::Search search = analysis::Search::lazy;
    std::uint32_t seeds = usual_seeds;
    std::uint64_t seed = 1;
    std::string folder;
    unsigned jobs = 0;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    scenario::Options options;
};

/// The condition whose signals are chosen.
experiment::ConditionSpec base_of(const Arguments& arguments) {
    const experiment::ConditionSpec base = shown_condition(chosen_conditions(arguments.conditions), "equip");
    if (base.settings.contains(experiment::equipped_setting))
        throw core::InputError({experiment::equipped_setting, "is what equip finds out", "",
                                "Leave it out, or compare sets of your own with clearway run"});
    const bool has_signals = !experiment::policies_with(base, traffic::Trait::asks_signals).empty();
    const bool has_own_code = std::ranges::any_of(
        base.policies, [](const std::string& policy) { return python::part_name_from(policy).has_value(); });
    if (!has_signals && !has_own_code)
        throw core::InputError(
            {"condition " + base.name, "has no policy that asks signals for green",
             fmt::format("one with {}, such as corridor",
                         core::listed(policy::policies().names(traffic::Trait::asks_signals))),
             "Leave --condition and --policy out for corridor"});
    return base;
}

struct Signals {
    scenario::BuiltNetwork built;
    campaign::EquipCandidates candidates;

    const roads::Signal& signal(std::size_t candidate) const {
        return built.network.signal(candidates.signals.at(candidate));
    }
};

Signals signals_of(const study::StudyConfig& config, const std::filesystem::path& folder) {
    const scenario::ScenarioConfig& scenario = config.scenarios.front();
    Signals signals{scenario::build_network(scenario, folder), {}};
    if (signals.built.network.signals().empty())
        throw core::InputError({"scenario " + scenario.name, "has no signals", "a network with signals",
                                "`clearway signals SCENARIO` lists those of a scenario"});
    signals.candidates = campaign::equip_candidates(config, signals.built);
    return signals;
}

std::optional<analysis::Estimate> less(const analysis::Values& before, const analysis::Values& after) {
    return analysis::estimate_paired(before, after, analysis::MetricKind::quantity);
}

std::optional<analysis::Estimate> mean(const campaign::EquipOutcome& outcome) {
    return analysis::estimate_values(outcome.emergency_s, analysis::MetricKind::quantity);
}

report::EquippedSignal row_of(const analysis::EquipStep& step, const analysis::SignalSet& set,
                              const Signals& signals, const campaign::EquipRounds& rounds) {
    const core::SignalIndex index = signals.candidates.signals.at(step.candidate);
    return {index.value + std::size_t{1}, signals.signal(step.candidate).id, step.gain, step.so_far,
            less(rounds.of(set).others_s, rounds.none().others_s)};
}

report::EquipmentFacts facts_of(const study::StudyConfig& config, const std::string& condition,
                                const analysis::EquipPlan& plan, const Signals& signals,
                                const campaign::EquipRounds& rounds) {
    report::EquipmentFacts facts;
    facts.scenario = config.scenarios.front().name;
    facts.title = config.scenarios.front().title;
    facts.condition = condition;
    facts.seed = config.seed;
    facts.replications = config.replications;
    facts.signals = signals.built.network.signals().size();
    facts.not_passed = signals.candidates.not_passed;
    facts.switched_off = signals.candidates.switched_off;
    facts.measured = plan.measured;
    facts.baseline_s = mean(rounds.baseline());
    facts.none_s = mean(rounds.none());
    facts.all_s = mean(rounds.all());
    facts.alone_s = mean(rounds.alone());
    facts.all_gain = less(rounds.none().emergency_s, rounds.all().emergency_s);
    facts.all_others = less(rounds.all().others_s, rounds.none().others_s);
    facts.end = plan.end;
    analysis::SignalSet set;
    for (const analysis::EquipStep& step : plan.steps) {
        set.push_back(step.candidate);
        facts.ranked.push_back(row_of(step, set, signals, rounds));
    }
    if (plan.next) {
        set.push_back(plan.next->candidate);
        facts.next = row_of(*plan.next, set, signals, rounds);
    }
    return facts;
}

void write_files(const report::EquipmentFacts& facts, const Signals& signals,
                 const std::filesystem::path& folder) {
    std::vector<core::SignalIndex> ranked;
    for (const report::EquippedSignal& row : facts.ranked)
        ranked.push_back(core::SignalIndex{static_cast<std::uint32_t>(row.number - 1)});
    const std::string title = facts.title + ": signals to equip first";
    core::write_atomically(folder / "equip.csv", report::equipment_csv(facts));
    core::write_atomically(folder / "equip.json", report::equipment_json(facts));
    core::write_atomically(folder / "curve.svg", report::equipment_curve(facts));
    core::write_atomically(folder / "map.svg",
                           scenario::ranked_signals_picture(signals.built.network, title, ranked));
}

study::StudyConfig study_of(const Arguments& arguments) {
    study::StudyConfig config;
    config.seed = arguments.seed;
    config.replications = arguments.seeds;
    config.scenarios = {scenario::load(arguments.scenario, arguments.options)};
    config.name = "equip-" + config.scenarios.front().name;
    return config;
}

/// `runs/equip-SCENARIO-xxxxxx`, where the hash stands for what is run.
std::filesystem::path folder_of(const Arguments& arguments, study::StudyConfig config,
                                const experiment::ConditionSpec& base) {
    if (!arguments.folder.empty()) return arguments.folder;
    config.conditions = {experiment::baseline_for(base), base};
    campaign::RunPlanOptions options;
    campaign::plan_for(config, options);
    return options.folder;
}

core::ExitCode equip(const Arguments& arguments, const Invocation& invocation) {
    const experiment::ConditionSpec base = base_of(arguments);
    const study::StudyConfig config = study_of(arguments);
    const core::TemporaryFolder network_folder;
    const Signals signals = signals_of(config, network_folder.path());
    std::vector<std::string> ids;
    for (const core::SignalIndex signal : signals.candidates.signals)
        ids.push_back(signals.built.network.signal(signal).id);
    campaign::RunPlanOptions options{.folder = folder_of(arguments, config, base),
                                     .workers = arguments.jobs,
                                     .limits = arguments.limits,
                                     .command = invocation.command};
    const std::filesystem::path folder = options.folder;
    campaign::EquipRounds rounds(config, base, ids, std::move(options));
    rounds.begin();
    const analysis::EquipConfig search{ids.size(), arguments.budget, arguments.search};
    const analysis::EquipPlan plan = analysis::equip_greedily(
        rounds.none().emergency_s, search,
        [&](const std::vector<analysis::SignalSet>& sets) { return rounds.measure(sets); });
    report::EquipmentFacts facts = facts_of(config, base.name, plan, signals, rounds);
    facts.budget = arguments.budget;
    write_files(facts, signals, folder);
    fmt::print("{}", arguments.printing == Printing::json ? report::equipment_json(facts)
                                                          : report::equipment_text(facts));
    fmt::print(stderr, "clearway: written: equip.csv, equip.json, curve.svg and map.svg in {}\n",
               folder.string());
    return rounds.failed_runs() == 0 ? core::ExitCode::ok : core::ExitCode::runs_failed;
}

void add_study_options(CLI::App& app, const std::shared_ptr<Arguments>& arguments) {
    app.add_option("--budget", arguments->budget, "How many signals to equip")
        ->required()
        ->check(CLI::Range(std::size_t{1}, most_signals))
        ->option_text(fmt::format("N, 1 to {} (required)", most_signals));
    add_condition_words(app, arguments->conditions);
    app.add_flag_callback(
        "--thorough", [arguments] { arguments->search = analysis::Search::thorough; },
        "Try every signal for every place [those that could still be the best]");
    app.add_option("--seeds", arguments->seeds, "Replications; all sets of signals share their demand")
        ->check(CLI::Range(2U, most_replications))
        ->option_text(fmt::format("N, 2 to {} [{}]", most_replications, arguments->seeds));
    add_seed_option(app, arguments->seed);
    app.add_option("--out", arguments->folder,
                   "Folder of the result and of the runs; what was interrupted there is continued")
        ->option_text("DIR [runs/equip-SCENARIO-xxxxxx, a hash of what is run]");
    add_jobs_option(app, arguments->jobs);
    add_limit_options(app, arguments->limits);
    add_json_option(app, arguments->printing, "the result");
}

}  // namespace

Action configure_equip(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("scenario", arguments->scenario, "Name (clearway list), folder or TOML file")
        ->required()
        ->option_text("SCENARIO (required)");
    add_study_options(app, arguments);
    add_own_condition_options(app, arguments->conditions.own);
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) { return equip(*arguments, invocation); };
}

}  // namespace clearway::cli
