#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::report {

/// One level of a setting. Both differences are paired by replication, against the same condition at its
/// defaults; below 0 is a gain.
struct SensitivityLevel {
    std::string value;                            ///< As set.
    std::optional<analysis::Estimate> emergency;  ///< Restricted mean travel time of emergency vehicles, s.
    std::optional<analysis::Estimate> others;     ///< Time loss of the other vehicles, s.
};

/// One setting, varied alone.
struct SensitivityRow {
    std::string setting;  ///< `preempt_signals.lead_s`.
    std::vector<SensitivityLevel> levels;

    /// Largest absolute mean difference of emergency vehicles among the levels, s.
    double reach_s() const;
};

/// How much a condition's outcome depends on each of its settings, varied one at a time.
struct Sensitivity {
    std::string scenario;
    std::string condition;             ///< The one at its defaults.
    std::vector<SensitivityRow> rows;  ///< The setting with the largest reach first.
};

/// Sensitivities of a study: for each condition at its defaults, the conditions that differ from it in
/// exactly one setting. Conditions for which fewer than two settings were varied are left out.
std::vector<Sensitivity> sensitivities(const analysis::Summary& summary);

/// Table for a terminal of 80 columns; empty text without sensitivities.
std::string sensitivity_table(const std::vector<Sensitivity>& all);

}  // namespace clearway::report
