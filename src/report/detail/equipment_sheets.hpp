#pragma once

#include <string>
#include <vector>

#include "report/detail/sheet.hpp"
#include "report/equipment.hpp"

namespace clearway::report::detail {

/// Of the gain of all signals: how many signals bring it is said.
inline constexpr double great_share = 0.8;

/// The ranks for people.
Sheet ranks_table(const EquipmentFacts& facts);
/// What the first signals bring together, a row for each number of them, then what all bring.
Sheet curve_table(const EquipmentFacts& facts);
Sheet event_sheet(const EquipmentFacts& facts);
/// The greatest gain first.
Sheet candidate_sheet(const EquipmentFacts& facts);
Sheet pair_sheet(const EquipmentFacts& facts);

analysis::MaybeEstimate without_interval(analysis::MaybeEstimate value);
/// What was found, a sentence each, the answer first.
std::vector<std::string> findings_of(const EquipmentFacts& facts);
/// A command for a study of those that were chosen; empty without any.
std::string study_command(const EquipmentFacts& facts);
/// What stands above `study_command`.
std::string study_words(const EquipmentFacts& facts);
/// The command with as many seeds as would likely tell more; empty where they are not worth it.
std::string more_seeds_command(const EquipmentFacts& facts);
inline constexpr const char* more_seeds_words = "More seeds would likely tell:";
/// How to ask for signals alone; empty where only signals were asked.
std::string signals_alone_sentence(const EquipmentFacts& facts);
/// What was left out, and EV times.
std::vector<std::string> circumstances_of(const EquipmentFacts& facts);
/// How the columns are to be read.
std::string ranks_legend(const EquipmentFacts& facts);
std::string curve_legend(const EquipmentFacts& facts);
std::string event_legend(const EquipmentFacts& facts);
std::string candidate_legend(const EquipmentFacts& facts);
std::string pair_legend();

/// A drawing of the page; without one where there is nothing to draw.
Figure curve_figure(const EquipmentFacts& facts);
Figure candidates_figure(const EquipmentFacts& facts);
Figure equipment_map_figure(const EquipmentFacts& facts);

}  // namespace clearway::report::detail
