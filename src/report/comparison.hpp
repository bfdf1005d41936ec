#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::report {

/// Titles of conditions, by scenario and name; a condition without one is called by its name.
using ConditionTitleMap = std::map<std::pair<std::string, std::string>, std::string>;

/// A gate: the metric may be worse by at most `largest`, in its unit.
struct Tolerance {
    std::string metric;
    double largest = 0.0;
};

/// A comparison that fails a tolerance.
struct Shortfall {
    std::string scenario;
    std::string condition;
    std::string metric;  ///< Or `runs`, or `emergency vehicles`, `other vehicles` for an objection.
    std::string why;     ///< `its interval reaches to +2.3 s`, `too few seeds: ...`.
};

/// Whether higher values of a metric are better, as for arrivals and correct links. For most metrics lower
/// values are.
bool more_is_better(const std::string& metric);

/// If there is any tolerance: first all runs that are not paired, because a condition that is not there
/// cannot pass. Then every objection against a condition, because no tolerance of a mean outweighs a lost
/// emergency vehicle (see analysis::Objections). Then every comparison whose 95 % interval does not show that
/// the condition is worse by at most the tolerance. A comparison of fewer than five pairs falls short. Throws
/// std::out_of_range for an unknown metric.
std::vector<Shortfall> shortfalls(const analysis::Summary& summary, const std::vector<Tolerance>& tolerances);

/// The paired table of each scenario and metric for a terminal of 100 columns.
std::string comparison_text(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                            const ConditionTitleMap& titles = {});

/// The same as one JSON object, with the shortfalls and the titles of all conditions; null for missing
/// values.
std::string comparison_json(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                            const std::vector<Shortfall>& short_of, const ConditionTitleMap& titles = {});

}  // namespace clearway::report
