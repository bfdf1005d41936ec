#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "analysis/estimate.hpp"
#include "analysis/summary.hpp"

namespace clearway::analysis {

/// The interval of a metric that needs most replications in a study.
struct Precision {
    std::string scenario;
    std::string condition;
    double half_width = 0.0;   ///< Reached, in the metric's unit.
    std::size_t n = 0;         ///< Complete pairs, or runs, behind it.
    std::size_t required = 0;  ///< Pairs or runs needed for the wanted half width.
    std::size_t lost = 0;      ///< Replications without a pair or a run.
};

/// The condition that needs most replications for `half_width` of its difference from the baseline, or of its
/// mean in a study that compares nothing. Nothing when there is no interval yet. Throws std::out_of_range for
/// an unknown metric.
std::optional<Precision> widest(const Summary& summary, const std::string& metric, double half_width);

}  // namespace clearway::analysis
