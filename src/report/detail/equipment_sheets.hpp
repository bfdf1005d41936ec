#pragma once

#include <string>
#include <vector>

#include "report/detail/sheet.hpp"
#include "report/equipment.hpp"

namespace clearway::report::detail {

/// Of the gain of all signals: how many signals bring it is said.
inline constexpr double great_share = 0.8;

/// Ranks, with a row for `all` at the end if it is wanted.
enum class LastRow : std::uint8_t { ranked, all };
Sheet ranked_sheet(const EquipmentFacts& facts, LastRow last);
/// The greatest gain first.
Sheet candidate_sheet(const EquipmentFacts& facts);
Sheet pair_sheet(const EquipmentFacts& facts);

/// Whether the runs tell which signals come first; else those that were chosen stand in no order.
bool has_order(const EquipmentFacts& facts);
/// What was found, a sentence each, the answer first.
std::vector<std::string> findings_of(const EquipmentFacts& facts);
/// What was left out, and EV times.
std::vector<std::string> circumstances_of(const EquipmentFacts& facts);
/// How the columns are to be read.
std::string ranked_legend(const EquipmentFacts& facts);
std::string candidate_legend(const EquipmentFacts& facts);
std::string pair_legend();

/// A drawing of the page; without one where there is nothing to draw.
Figure curve_figure(const EquipmentFacts& facts);
Figure candidates_figure(const EquipmentFacts& facts);
Figure equipment_map_figure(const EquipmentFacts& facts);

}  // namespace clearway::report::detail
