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

/// One value per run or case.
template <class Items, class Value>
std::vector<double> column_of(const Items& items, const Value& value) {
    std::vector<double> column;
    for (const auto& item : items)
        column.push_back(static_cast<double>(value(item)));
    return column;
}

/// By run: true links at or above the threshold, and all pairs there.
struct CountsAbove {
    std::vector<double> found, predicted;
};
CountsAbove counts_above(const std::vector<LinkSummary>& runs, double threshold);

/// Sum of numerators / sum of denominators, over runs.
Drawn draw_ratio(const std::vector<double>& numerators, const std::vector<double>& denominators,
                 const analysis::RunResampling& resampling);

}  // namespace clearway::links::detail
