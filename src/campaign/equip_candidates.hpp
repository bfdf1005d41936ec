#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "analysis/equipment.hpp"
#include "core/ids.hpp"
#include "report/equipment.hpp"
#include "scenario/network.hpp"
#include "scenario/outlook.hpp"
#include "study/config.hpp"

namespace clearway::campaign {

/// Signals that equipment could help, and why the others are left out.
struct EquipCandidates {
    std::vector<core::SignalIndex> signals;  ///< Ascending.
    /// By replication: which of them emergency vehicles pass there, ascending.
    std::vector<analysis::SignalSet> passed;
    std::vector<double> trips;  ///< By candidate: share of the emergency vehicles that pass it.
    /// Candidates that follow each other on ways, the most driven first, six at most.
    std::vector<std::array<std::size_t, 2>> neighbours;
    report::SignalsMet met;
    std::size_t not_passed = 0;      ///< No emergency vehicle passes them.
    std::size_t equipped = 0;        ///< Passed, but equipped today.
    std::size_t switched_off = 0;    ///< Passed, but their preemption parameters have `enabled` 0.
    std::size_t less_red = 0;        ///< Emergency vehicles wait longer at red at each of `most` others.
    scenario::Outlook outlook = {};  ///< Of the first replication.
};

/// The signals that emergency vehicles of a study's first scenario pass in any of its replications, without
/// those that are equipped `today` (by core::SignalIndex; empty: none is); if they are more than `most`,
/// those where these vehicles wait longest at red in all (scenario::red_waits_s), of equal ones those that
/// most pass, then the first. Throws as scenario::prepare does.
EquipCandidates equip_candidates(const study::StudyConfig& config, const scenario::BuiltNetwork& built,
                                 const std::vector<bool>& today, std::size_t most);

/// By replication of a study's first scenario: the emergency vehicles that pass one of these signals.
std::vector<std::set<std::string>> trips_past(const std::vector<core::SignalIndex>& signals,
                                              const study::StudyConfig& config,
                                              const scenario::BuiltNetwork& built);

}  // namespace clearway::campaign
