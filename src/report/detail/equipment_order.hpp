#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/equipment.hpp"

namespace clearway::report::detail {

/// Whether no trip was a step faster or slower.
bool is_exactly_none(const analysis::MaybeEstimate& gain);
/// Whether locks held up an EV, or one vehicle in a hundred, in most of the runs.
bool most_are_held_up(const UnsoundRuns& unsound);
/// The pair that a signal was chosen in; nothing for one that was chosen alone.
const EquipPairFacts* pair_of(const EquipmentFacts& facts, const EquippedSignal& signal);
/// Its gain, or that of the pair that it was chosen in.
bool is_shown_of(const EquipmentFacts& facts, const EquippedSignal& signal);
/// Whether it changed no trip of the fresh seeds, so that its rank is chance.
bool is_chance(const EquipmentFacts& facts, const EquippedSignal& signal);

/// Whether the runs tell which signals come first: the gain of the first, or of the pair that it was chosen
/// in, is shown. Else those that were chosen stand in no order.
bool has_order(const EquipmentFacts& facts);
/// Without an order: whether what the chosen bring together is shown.
bool tells_sum(const EquipmentFacts& facts);
/// Without such a sum: whether what trips gain that pass a chosen signal is shown.
bool tells_passing(const EquipmentFacts& facts);

/// Whether the others gain by the chosen signals in the mean: their times are then told as savings.
bool others_save(const EquipmentFacts& facts);
/// A loss of the others as others_save has it told.
analysis::MaybeEstimate others_cell(const EquipmentFacts& facts, const analysis::MaybeEstimate& loss);

/// How many seeds would likely show the gain of all ranks, if it and its spread are what they look like; 0
/// where it is shown, or none.
std::size_t seeds_to_show(const EquipmentFacts& facts);
/// Pairs that would likely show the gain of the first place, if it and its spread are what they look like; 0
/// where no number would.
std::size_t pairs_to_tell(const EquipmentFacts& facts);
/// As small_map_words.
std::string small_map_of(const EquipmentFacts& facts);

/// `#4 Via Po / Via Roma`
std::string numbered_name(const EquippedSignal& signal);
/// The answer for those who decide and do not simulate, a sentence or two a line; empty where nothing was
/// chosen.
std::vector<std::string> council_lines(const EquipmentFacts& facts);

}  // namespace clearway::report::detail
