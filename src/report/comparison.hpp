#pragma once

#include <string>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::report {

/// A gate: the metric may be worse by at most `largest`, in its unit.
struct Tolerance {
    std::string metric;
    double largest = 0.0;
};

/// A comparison that a tolerance does not let through.
struct Shortfall {
    std::string scenario;
    std::string condition;
    std::string metric;  ///< Or `emergency vehicles`, `other vehicles` for an objection.
    std::string why;     ///< `its interval reaches to +2.3 s`, `there is no interval`.
};

/// Whether more of a metric is better: arrivals and right links. Of all others less is.
bool more_is_better(const std::string& metric);

/// Where there is a tolerance at all: every objection against a condition, for no tolerance of a mean
/// outweighs a lost emergency vehicle (see analysis::Objections). Then comparisons for which the 95 %
/// interval of the difference does not show that the condition is worse by no more than the tolerance. One
/// without an interval shows nothing and falls short; pairs that are all equal have one. Throws
/// std::out_of_range for an unknown metric.
std::vector<Shortfall> shortfalls(const analysis::Summary& summary, const std::vector<Tolerance>& tolerances);

/// The paired table of each scenario and metric for a terminal of 110 columns.
std::string comparison_text(const analysis::Summary& summary, const std::vector<std::string>& metrics);

/// The same for machines, with the shortfalls: one JSON object, null for "not available".
std::string comparison_json(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                            const std::vector<Shortfall>& short_of);

}  // namespace clearway::report
