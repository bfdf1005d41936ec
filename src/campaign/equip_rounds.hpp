#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "analysis/equipment.hpp"
#include "campaign/study_run.hpp"
#include "experiment/condition.hpp"
#include "results/store.hpp"
#include "roads/network.hpp"
#include "scenario/network.hpp"
#include "study/config.hpp"

namespace clearway::campaign {

/// Signals that equipment could help, and why the others are left out.
struct EquipCandidates {
    std::vector<core::SignalIndex> signals;  ///< Ascending.
    std::size_t not_passed = 0;              ///< No emergency vehicle passes them.
    std::size_t switched_off = 0;            ///< Passed, but their preemption parameters have `enabled` 0.
};

/// The signals that emergency vehicles of a study's first scenario pass in any of its replications. Throws as
/// scenario::prepare does.
EquipCandidates equip_candidates(const study::StudyConfig& config, const scenario::BuiltNetwork& built);

/// What a set of equipped signals does, by replication; nothing for runs that failed.
struct EquipOutcome {
    analysis::Values emergency_s;  ///< `analysis::primary_metric`.
    analysis::Values others_s;     ///< Mean time loss of the others.
};

/// The runs behind a choice of signals: one run folder a round below `options.folder`, so that the same call
/// continues what was interrupted. `round-01` has the baseline, the policy with every signal and with none,
/// emergency vehicles alone, and each candidate by itself; the later ones take the baseline's runs from it.
class EquipRounds {
  public:
    /// `config` has scenario, seed and replications; `base` is the condition whose signals are chosen.
    EquipRounds(study::StudyConfig config, experiment::ConditionSpec base, std::vector<std::string> signals,
                RunOptions options);

    /// Makes the first round. Throws as run_missing does, and core::Error with its exit code when
    /// interrupted.
    void begin();
    /// Makes the missing runs of these sets of candidates, all of one size. Call after `begin`; throws
    /// likewise.
    std::vector<analysis::Values> measure(const std::vector<analysis::SignalSet>& sets);

    const EquipOutcome& baseline() const { return baseline_; }
    const EquipOutcome& none() const { return none_; }
    const EquipOutcome& all() const { return all_; }
    const EquipOutcome& alone() const { return alone_; }
    /// Of a set that was measured.
    const EquipOutcome& of(const analysis::SignalSet& set) const { return sets_.at(set); }
    std::size_t failed_runs() const { return failed_runs_; }

    /// The condition with these candidates equipped, the others not.
    experiment::ConditionSpec with(const analysis::SignalSet& set) const;

  private:
    /// Runs the conditions beside the baseline in a folder below that of the rounds.
    results::Results run(const std::string& round, std::vector<experiment::ConditionSpec> conditions);

    study::StudyConfig config_;
    experiment::ConditionSpec base_;
    std::vector<std::string> signals_;  ///< Ids of the candidates.
    RunOptions options_;
    EquipOutcome baseline_, none_, all_, alone_;
    std::map<analysis::SignalSet, EquipOutcome> sets_;
    std::size_t failed_runs_ = 0;
};

}  // namespace clearway::campaign
