#pragma once

#include <vector>

#include "analysis/resampling.hpp"
#include "links/link_histogram.hpp"
#include "links/link_judgement.hpp"

namespace clearway::links::detail {

/// A measure of the whole sample and of every resample; NaN where a resample does not define it.
struct Drawn {
    std::optional<double> value;
    std::vector<double> draws;

    analysis::Measured measured(const analysis::RunResampling& resampling) const {
        return {value, value ? resampling.interval(draws) : std::nullopt};
    }
};

/// The measures of one kind of pairs.
struct DrawnMeasures {
    LinkSummary sum;
    Drawn ap, auc, f1, log_loss, ece, brier;
};

/// `runs` has one summary per run. Ranking measures of resamples are computed on a grid eight times as coarse
/// and shifted by the difference between both grids on the whole sample.
DrawnMeasures draw_measures(const std::vector<LinkSummary>& runs, double threshold,
                            const analysis::RunResampling& resampling);

/// Sum of numerators / sum of denominators, over runs.
Drawn draw_ratio(const std::vector<double>& numerators, const std::vector<double>& denominators,
                 const analysis::RunResampling& resampling);

}  // namespace clearway::links::detail
