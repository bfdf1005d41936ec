#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

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
    std::size_t most_candidates = std::numeric_limits<std::size_t>::max();
    analysis::Search search = analysis::Search::lazy;
    std::uint64_t seed = 1;
    std::uint32_t replications = 2;
    /// Words of a command that runs a study of this scenario and condition, but for seeds and equipped
    /// signals.
    std::vector<std::string> study = {};
    double density = 1.0;  ///< `--density` of the command.
    // Words of the command itself, with less traffic, for where vehicles lock each other, and for more seeds,
    // but for their number.
    std::vector<std::string> words = {}, calmer = {}, more_seeds = {};
    double within_s = 0.0;  ///< Time that decides on `replications`, by a forecast; 0: none is given.
    RunOptions run;         ///< Its folder is that of the result and of the rounds.
};

/// Chooses signals from runs in rounds, estimates their gains from runs on fresh seeds, writes report.html,
/// equip.csv, candidates.csv, equip.json, curve.svg and map.svg, and prints candidates and ranks. Returns
/// runs_failed when a run failed. Where it is interrupted it prints the gains of the last look. What it
/// prints is kept in equip.txt; gains of a look do not replace an answer. Throws core::InputError for a
/// condition that asks no signal for green and a network without signals, and as EquipRounds does.
core::ExitCode equip(EquipRequest request);

/// Whether a folder is one of `equip`, which is no run folder.
bool is_equip_folder(const std::filesystem::path& folder);

/// Throws core::InputError for a folder of a round of `equip`, whose runs are unequally many by design.
void refuse_round(const std::filesystem::path& folder);

/// Throws core::InputError where the answer of a search, and so this file of it, is not there yet.
void require_equip_file(const std::filesystem::path& folder, const char* name);

/// Prints what `equip` last printed for this folder. Throws core::InputError where it has printed nothing.
void print_equip_folder(const std::filesystem::path& folder, Printing printing);

/// Prints how many runs `equip` would make, and about how long they take; makes none. Throws likewise, and
/// where the folder holds another search.
core::ExitCode equip_dry_run(EquipRequest request);

}  // namespace clearway::campaign
