#include "campaign/equip.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/equip_rounds.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/conditions.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "policy/policy.hpp"
#include "python/part_name.hpp"
#include "report/equipment.hpp"
#include "scenario/network.hpp"
#include "scenario/picture.hpp"

namespace clearway::campaign {
namespace {

void check_condition(const experiment::ConditionSpec& base) {
    if (base.settings.contains(experiment::equipped_setting))
        throw core::InputError({experiment::equipped_setting, "is chosen by equip itself", "",
                                "Leave it out, or compare your own sets with clearway run"});
    const bool has_signals = !experiment::policies_with(base, traffic::Trait::asks_signals).empty();
    const bool has_own_code = std::ranges::any_of(
        base.policies, [](const std::string& policy) { return python::part_name_from(policy).has_value(); });
    if (!has_signals && !has_own_code)
        throw core::InputError(
            {"condition " + base.name, "has no policy that requests green from signals",
             fmt::format("one with {}, such as corridor",
                         core::listed(policy::policies().names(traffic::Trait::asks_signals))),
             "Leave out --condition and --policy to use corridor"});
}

struct Signals {
    scenario::BuiltNetwork built;
    EquipCandidates candidates;

    const roads::Signal& signal(std::size_t candidate) const {
        return built.network.signal(candidates.signals.at(candidate));
    }
};

Signals signals_of(const study::StudyConfig& config, const std::filesystem::path& folder) {
    const scenario::ScenarioConfig& scenario = config.scenarios.front();
    Signals signals{scenario::build_network(scenario, folder), {}};
    if (signals.built.network.signals().empty())
        throw core::InputError({"scenario " + scenario.name, "has no signals", "a network with signals",
                                "`clearway scenario signals SCENARIO` lists those of a scenario"});
    signals.candidates = equip_candidates(config, signals.built);
    return signals;
}

std::optional<analysis::Estimate> less(const analysis::Values& before, const analysis::Values& after) {
    return analysis::estimate_paired(before, after, analysis::MetricKind::quantity);
}

std::optional<analysis::Estimate> mean(const EquipOutcome& outcome) {
    return analysis::estimate_values(outcome.emergency_s, analysis::MetricKind::quantity);
}

report::EquippedSignal row_of(const analysis::EquipStep& step, const analysis::SignalSet& set,
                              const Signals& signals, const EquipRounds& rounds) {
    const core::SignalIndex index = signals.candidates.signals.at(step.candidate);
    return {index.value + std::size_t{1}, signals.signal(step.candidate).id, step.gain, step.so_far,
            less(rounds.of(set).others_s, rounds.none().others_s)};
}

report::EquipmentFacts facts_of(const study::StudyConfig& config, const std::string& condition,
                                const analysis::EquipPlan& plan, const Signals& signals,
                                const EquipRounds& rounds) {
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

/// `runs/equip-SCENARIO-xxxxxx`, where the hash stands for what is run.
std::filesystem::path usual_folder(study::StudyConfig config, const experiment::ConditionSpec& base) {
    config.conditions = {experiment::baseline_for(base), base};
    RunOptions options;
    plan_for(config, options);
    return options.folder;
}

}  // namespace

core::ExitCode equip(EquipRequest request) {
    const experiment::ConditionSpec& base = request.condition;
    check_condition(base);
    study::StudyConfig config = study_of(request.scenario, {}, request.seed, request.replications);
    config.name = "equip-" + config.name;
    const core::TemporaryFolder network_folder;
    const Signals signals = signals_of(config, network_folder.path());
    const std::vector<std::string> ids = core::texts_of(
        signals.candidates.signals,
        [&](const core::SignalIndex signal) { return signals.built.network.signal(signal).id; });
    if (request.run.folder.empty()) request.run.folder = usual_folder(config, base);
    const std::filesystem::path& folder = request.run.folder;
    EquipRounds rounds(config, base, ids, request.run);
    rounds.begin();
    const analysis::EquipConfig search{ids.size(), request.budget, request.search};
    const analysis::EquipPlan plan = analysis::equip_greedily(
        rounds.none().emergency_s, search,
        [&](const std::vector<analysis::SignalSet>& sets) { return rounds.measure(sets); });
    report::EquipmentFacts facts = facts_of(config, base.name, plan, signals, rounds);
    facts.budget = request.budget;
    write_files(facts, signals, folder);
    fmt::print("{}", request.run.publish.printing == Printing::json ? report::equipment_json(facts)
                                                                    : report::equipment_text(facts));
    fmt::print(stderr, "clearway: written: equip.csv, equip.json, curve.svg and map.svg in {}\n",
               folder.string());
    return rounds.failed_runs() == 0 ? core::ExitCode::ok : core::ExitCode::runs_failed;
}

}  // namespace clearway::campaign
