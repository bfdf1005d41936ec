#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::report {

/// One level of a setting. Both differences are paired by replication, against the same condition at its
/// defaults; below 0 is a gain.
struct SensitivityLevel {
    std::string condition;                        ///< Name of the condition that was run with it.
    std::string value;                            ///< As set.
    std::optional<analysis::Estimate> emergency;  ///< Restricted mean travel time of emergency vehicles, s.
    std::optional<analysis::Estimate> others;     ///< Time loss of the other vehicles, s.
    /// What rules a gain out against the baseline (`lost EVs`); empty if nothing does.
    std::string objection;
};

/// One setting, varied alone.
struct SensitivityRow {
    std::string setting;  ///< `preempt_signals.lead_s`.
    std::string shipped;  ///< Default of this version; empty where it depends on the scenario or is unknown.
    std::vector<SensitivityLevel> levels;

    /// Largest absolute mean difference of emergency vehicles among the levels, s.
    double reach_s() const;
    /// Whether the interval of some level excludes 0.
    bool changes(std::optional<analysis::Estimate> SensitivityLevel::*difference) const;
    /// Whether every level has both intervals, all of them include 0, and nothing is objected to any.
    bool shows_nothing() const;
    /// `60 -> 30`, with `arrow` between the shipped value and the level's.
    std::string turned(const SensitivityLevel& level, const char* arrow) const;
};

/// How much a condition's outcome depends on each of its settings, varied one at a time.
struct Sensitivity {
    std::string scenario;
    std::string condition;             ///< The one at its defaults.
    std::vector<SensitivityRow> rows;  ///< The setting with the largest reach first.

    /// Whether a condition of a scenario is one of the levels.
    bool has_level(const std::string& of_scenario, const std::string& named) const;
};

/// Sensitivities of a study: for each condition at its defaults, the conditions that differ from it in
/// exactly one setting and are no `controls` (StudyConfig::controls). Conditions for which fewer than two
/// settings were varied are left out.
std::vector<Sensitivity> sensitivities(const analysis::Summary& summary, const core::Settings& controls = {});

/// How many settings change the outcome beyond the interval. Plain text, one sentence.
std::string sensitivity_sentence(const Sensitivity& sensitivity);

/// Which settings `sensitivity_table` lists.
enum class SensitivityRows : std::uint8_t { with_effect, all };
/// Table for a terminal of 80 columns; empty text without sensitivities. Rows that are left out are counted.
std::string sensitivity_table(const std::vector<Sensitivity>& all, SensitivityRows rows);

}  // namespace clearway::report
