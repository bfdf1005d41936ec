#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "analysis/estimate.hpp"
#include "analysis/summary.hpp"

namespace clearway::analysis {

/// The widest interval of a metric in a study, and how many replications it wants.
struct Precision {
    std::string scenario;
    std::string condition;
    double half_width = 0.0;   ///< Reached, in the metric's unit.
    std::size_t n = 0;         ///< Complete pairs, or runs, behind it.
    std::size_t required = 0;  ///< Of these, for the half width that was asked for.
    std::size_t lost = 0;      ///< Replications without a pair or a run.
};

/// The condition that needs most replications for `half_width`, by its difference from the baseline; in a
/// study that compares nothing, by its mean. Nothing when there is no interval yet. Throws std::out_of_range
/// for an unknown metric.
std::optional<Precision> widest(const Summary& summary, const std::string& metric, double half_width);

}  // namespace clearway::analysis
