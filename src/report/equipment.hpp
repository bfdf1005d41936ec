#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/equipment.hpp"

namespace clearway::report {

/// A signal that was chosen.
struct EquippedSignal {
    std::size_t number = 0;                    ///< As `clearway scenario signals` counts, from 1.
    std::string signal;                        ///< Its id; text from a file.
    std::optional<analysis::Estimate> gain;    ///< Over those of better rank, s of EV time.
    std::optional<analysis::Estimate> so_far;  ///< Over no signal equipped.
    std::optional<analysis::Estimate> others;  ///< Time loss of the others over no signal equipped, s each.
};

/// Which signals to equip first, and what that is worth. Gains are restricted mean travel times of emergency
/// vehicles, paired by replication.
struct EquipmentFacts {
    std::string scenario;
    std::string title;
    std::string condition;
    std::uint64_t seed = 0;
    std::uint32_t replications = 0;
    std::size_t budget = 0;
    std::size_t signals = 0;       ///< Of the network.
    std::size_t not_passed = 0;    ///< Of them, no emergency vehicle passes in these replications.
    std::size_t switched_off = 0;  ///< Passed, but `enabled` is 0 in the scenario's preemption parameters.
    std::size_t measured = 0;      ///< Sets of signals for which runs were made.
    std::optional<analysis::Estimate> baseline_s;  ///< Time without the policy.
    std::optional<analysis::Estimate> none_s;      ///< With the policy, no signal equipped.
    std::optional<analysis::Estimate> all_s;       ///< With every signal equipped.
    std::optional<analysis::Estimate> alone_s;     ///< Of emergency vehicles alone on the road.
    std::optional<analysis::Estimate> all_gain;    ///< Every signal over none.
    std::optional<analysis::Estimate> all_others;
    std::vector<EquippedSignal> ranked;
    analysis::EquipEnd end = analysis::EquipEnd::budget;
    std::optional<EquippedSignal> next;  ///< With `no_effect`: the one that was not chosen.

    /// Signals that could gain.
    std::size_t candidates() const { return signals - not_passed - switched_off; }
};

/// Share of the gain of every signal that a signal and those before it bring. Nothing where that gain is not
/// shown to be above 0.
std::optional<double> share_of_all(const EquipmentFacts& facts, const EquippedSignal& signal);
/// Rank with which that share reaches `share`; nothing if none does.
std::optional<std::size_t> rank_with_share(const EquipmentFacts& facts, double share);

/// The ranked table for a terminal of 100 columns, and what it says.
std::string equipment_text(const EquipmentFacts& facts);
/// All of it as one JSON object; null for missing values.
std::string equipment_json(const EquipmentFacts& facts);
/// The curve as CSV: one row for each number of equipped signals, 0 included, and one for all of them.
std::string equipment_csv(const EquipmentFacts& facts);
/// The curve of gain against number equipped with its intervals, and the gain of all: a stand-alone SVG.
std::string equipment_curve(const EquipmentFacts& facts);

}  // namespace clearway::report
