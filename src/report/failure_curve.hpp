#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::report {

/// The result of a repair at one share of time dark.
struct FailurePoint {
    double dark_share = 0.0;
    /// Restricted mean EV travel time of the condition minus that of the baseline, s: below 0 is a benefit,
    /// unless there are objections.
    std::optional<analysis::Estimate> travel_time;
    /// F1 of the believed links end to end: links of vehicles never seen count as missed. Empty where the
    /// policy acts on places alone, because links then explain nothing.
    std::optional<analysis::Estimate> link_f1;
    analysis::Objections objections;
};

/// One repair over the share of time dark.
struct FailureLine {
    std::string repair;
    std::vector<FailurePoint> points;  ///< By rising share, at least one.
    /// Index of the first point that shows no benefit, because the interval of its difference reaches 0. A
    /// point without an interval, or with objections on the side of EVs, shows none either. Nothing if every
    /// point shows a benefit.
    std::optional<std::size_t> break_even;
};

/// Benefit against failure: what is left of a policy's benefit when vehicles are dark a share of the time.
struct FailureCurve {
    std::string scenario;
    std::string policy;              ///< Names, joined by ` + `.
    std::string failure;             ///< What the failures of all points have in common: `mean_outage_s=10`.
    std::vector<FailureLine> lines;  ///< In the order of the study; `perfect` sensing last, at every share.
};

/// The curves of a study: conditions of one traffic model that differ only in their predictor and the
/// `dark_share` of their failure. Curves of fewer than two shares are left out. A condition of the same
/// policy with failure `perfect` becomes the line `perfect`, the same at every share.
std::vector<FailureCurve> failure_curves(const analysis::Summary& summary);

/// Table for a terminal of 80 columns; empty text without curves.
std::string failure_table(const std::vector<FailureCurve>& curves);

}  // namespace clearway::report
