#include "campaign/equip_rounds.hpp"

#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/conditions.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "scenario/prepare.hpp"

namespace clearway::campaign {
namespace {

constexpr const char* first_round = "round-01";

/// The signals between each edge and the next.
using Crossings = std::map<std::pair<std::string, std::string>, std::set<core::SignalIndex>>;

Crossings crossings_of(const roads::Network& network) {
    Crossings crossings;
    std::uint32_t index = 0;
    for (const roads::Signal& signal : network.signals()) {
        const core::SignalIndex own{index++};
        for (const auto& link : signal.links) {
            for (const roads::SignalLink& way : link) {
                const auto edge = [&](core::LaneIndex lane) {
                    return network.edge(network.lane(lane).edge).id;
                };
                crossings[{edge(way.from), edge(way.to)}].insert(own);
            }
        }
    }
    return crossings;
}

EquipOutcome outcome_of(const results::Results& results, const std::string& condition) {
    EquipOutcome outcome;
    outcome.emergency_s.resize(results.manifest.replications);
    outcome.others_s.resize(results.manifest.replications);
    for (const results::RunRecord& run : results.runs) {
        if (run.key.condition != condition) continue;
        outcome.emergency_s.at(run.key.replication) = run.metrics.emergency_restricted_travel_time_s;
        outcome.others_s.at(run.key.replication) = run.metrics.others_time_loss_s;
    }
    return outcome;
}

/// Leaves no empty folder around a round that was refused.
results::Store prepared_folder(const study::Plan& plan, const RunOptions& options) {
    try {
        return prepare_run_folder(plan, options);
    } catch (const core::InputError&) {
        std::error_code ignored;
        std::filesystem::remove(options.folder.parent_path(), ignored);  // only if it is empty
        throw;
    }
}

/// Takes the runs of a condition that another folder of the same scenario, seed and condition has.
void take_over(const std::string& condition, const std::filesystem::path& from, const results::Store& store) {
    const results::Store source = results::Store::open(from);
    for (const experiment::RunKey& key : source.complete_runs()) {
        if (key.condition == condition && !store.complete(key)) store.adopt(source, key);
    }
}

}  // namespace

EquipCandidates equip_candidates(const study::StudyConfig& config, const scenario::BuiltNetwork& built) {
    const Crossings crossings = crossings_of(built.network);
    std::set<core::SignalIndex> passed;
    for (std::uint32_t replication = 0; replication < config.replications; ++replication) {
        const core::TemporaryFolder folder;
        const scenario::Prepared prepared =
            scenario::prepare(config.scenarios.front(), built, core::StudySeed{config.seed},
                              core::Replication{replication}, folder.path());
        for (const traffic::EmergencyDeparture& departure : prepared.emergency) {
            for (std::size_t at = 1; at < departure.edges.size(); ++at) {
                const auto found = crossings.find({departure.edges[at - 1], departure.edges[at]});
                if (found != crossings.end()) passed.insert(found->second.begin(), found->second.end());
            }
        }
    }
    EquipCandidates candidates;
    candidates.not_passed = built.network.signals().size() - passed.size();
    for (const core::SignalIndex signal : passed) {
        const bool is_off =
            !built.preemption.empty() && built.preemption[signal.value].enabled.value_or(1) == 0;
        if (is_off) {
            ++candidates.switched_off;
        } else {
            candidates.signals.push_back(signal);
        }
    }
    return candidates;
}

EquipRounds::EquipRounds(study::StudyConfig config, experiment::ConditionSpec base,
                         std::vector<std::string> signals, RunOptions options)
    : config_(std::move(config)),
      base_(std::move(base)),
      signals_(std::move(signals)),
      options_(std::move(options)) {}

experiment::ConditionSpec EquipRounds::with(const analysis::SignalSet& set) const {
    experiment::ConditionSpec condition = base_;
    std::vector<std::string> ids =
        core::texts_of(set, [&](const std::size_t candidate) { return signals_.at(candidate); });
    const std::string equipped =
        ids.empty() ? experiment::none_equipped : fmt::format("{}", fmt::join(ids, ","));
    condition.settings[experiment::equipped_setting] = equipped;
    condition.name += ids.empty() ? "_none_equipped"
                                  : fmt::format("_equipped_{}", core::content_hash(equipped).substr(0, 8));
    return condition;
}

results::Results EquipRounds::run(const std::string& round,
                                  std::vector<experiment::ConditionSpec> conditions) {
    const experiment::ConditionSpec baseline = experiment::baseline_for(base_);
    conditions.insert(conditions.begin(), baseline);
    study::StudyConfig config = config_;
    config.conditions = std::move(conditions);
    RunOptions options = options_;
    options.folder = options_.folder / round;
    const study::Plan plan = plan_for(config, options);
    const results::Store store = prepared_folder(plan, options);
    if (round != first_round) take_over(baseline.name, options_.folder / first_round, store);
    const StudyResult result = run_missing(plan, store, options);
    if (is_interrupted(result.exit_code))
        throw core::Error(result.exit_code, fmt::format("interrupted in {}", options.folder.string()));
    results::Results results = results::read_results(store, results::VehicleRows::emergency);
    if (!results.errors.empty()) {
        failed_runs_ += results.errors.size();
        fmt::print(stderr, "clearway: {} of {} runs failed in {}; `clearway report {}` names them\n",
                   results.errors.size(), plan.run_count(), options.folder.string(), options.folder.string());
    }
    return results;
}

void EquipRounds::begin() {
    const experiment::ConditionSpec solo = experiment::built_in_condition("solo", "solo");
    std::vector<experiment::ConditionSpec> conditions = {base_, with({}), solo};
    for (std::size_t candidate = 0; candidate < signals_.size(); ++candidate)
        conditions.push_back(with({candidate}));
    const results::Results results = run(first_round, conditions);
    baseline_ = outcome_of(results, experiment::baseline_for(base_).name);
    all_ = outcome_of(results, base_.name);
    none_ = outcome_of(results, with({}).name);
    alone_ = outcome_of(results, solo.name);
    for (std::size_t candidate = 0; candidate < signals_.size(); ++candidate)
        sets_[{candidate}] = outcome_of(results, with({candidate}).name);
}

std::vector<analysis::Values> EquipRounds::measure(const std::vector<analysis::SignalSet>& sets) {
    std::vector<experiment::ConditionSpec> missing;
    std::string names;
    for (const analysis::SignalSet& set : sets) {
        if (sets_.contains(set)) continue;
        missing.push_back(with(set));
        names += missing.back().name + "\n";
    }
    if (!missing.empty()) {
        const std::string round =
            fmt::format("round-{:02}-{}", sets.front().size(), core::content_hash(names).substr(0, 6));
        const results::Results results = run(round, missing);
        for (const analysis::SignalSet& set : sets) {
            if (!sets_.contains(set)) sets_[set] = outcome_of(results, with(set).name);
        }
    }
    std::vector<analysis::Values> values;
    for (const analysis::SignalSet& set : sets)
        values.push_back(sets_.at(set).emergency_s);
    return values;
}

}  // namespace clearway::campaign
