#pragma once

#include <cstddef>
#include <cstdint>

#include "analysis/equipment.hpp"
#include "campaign/study_run.hpp"
#include "experiment/condition.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {

/// Which signals of a scenario to equip first.
struct EquipRequest {
    scenario::ScenarioConfig scenario;
    experiment::ConditionSpec condition;  ///< Whose signals are chosen.
    std::size_t budget = 1;               ///< Signals to equip.
    analysis::Search search = analysis::Search::lazy;
    std::uint64_t seed = 1;
    std::uint32_t replications = 2;
    RunOptions run;  ///< Its folder is that of the result and of the rounds.
};

/// Chooses signals greedily from runs in rounds, writes equip.csv, equip.json, curve.svg and map.svg and
/// prints the ranked table. Returns runs_failed when a run failed. Throws core::InputError for a condition
/// that asks no signal for green and a network without signals, and as EquipRounds does.
core::ExitCode equip(EquipRequest request);

}  // namespace clearway::campaign
