#include "links/detail/link_draws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace clearway::links::detail {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t coarseness = 8;

/// Values by run and column; columns can be summed with a weight per run.
class Table {
  public:
    Table(std::size_t runs, std::size_t columns) : columns_(columns), values_(runs * columns, 0.0) {}

    double& at(std::size_t run, std::size_t column) { return values_[run * columns_ + column]; }
    void sum(std::span<const double> weights, std::vector<double>& total) const {
        total.assign(columns_, 0.0);
        for (std::size_t run = 0; run < weights.size(); ++run) {
            const double weight = weights[run];
            if (weight == 0.0) continue;
            const double* const row = values_.data() + run * columns_;
            for (std::size_t column = 0; column < columns_; ++column)
                total[column] += weight * row[column];
        }
    }

  private:
    std::size_t columns_;
    std::vector<double> values_;
};

/// Counts of every run on the coarse grid, without empty bins.
struct CoarseCounts {
    Table linked;
    Table unlinked;
};

CoarseCounts coarse_counts(const std::vector<LinkSummary>& runs) {
    std::vector<std::uint32_t> used;
    for (const LinkSummary& run : runs) {
        for (const LinkSummary::Bin& bin : run.bins)
            used.push_back(bin.bin / coarseness);
    }
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    CoarseCounts counts{Table(runs.size(), used.size()), Table(runs.size(), used.size())};
    for (std::size_t run = 0; run < runs.size(); ++run) {
        for (const LinkSummary::Bin& bin : runs[run].bins) {
            const auto column =
                static_cast<std::size_t>(std::ranges::lower_bound(used, bin.bin / coarseness) - used.begin());
            counts.linked.at(run, column) += static_cast<double>(bin.linked);
            counts.unlinked.at(run, column) += static_cast<double>(bin.unlinked);
        }
    }
    return counts;
}

/// Shifts all draws by the difference between `exact` and `sample`, the value of the whole sample on the
/// coarse grid.
void move_to(Drawn& drawn, const std::optional<double>& exact, const std::optional<double>& sample) {
    drawn.value = exact;
    if (!exact || !sample) return;
    for (double& draw : drawn.draws)
        draw += *exact - *sample;
}

void draw_rankings(const std::vector<LinkSummary>& runs, const analysis::RunResampling& resampling,
                   const metrics::LinkQuality& exact, DrawnMeasures& measures) {
    const CoarseCounts counts = coarse_counts(runs);
    std::vector<double> linked;
    std::vector<double> unlinked;
    const auto ranked = [&](std::span<const double> weights) {
        counts.linked.sum(weights, linked);
        counts.unlinked.sum(weights, unlinked);
        return RankedCounts{linked, unlinked};
    };
    for (std::size_t number = 0; number < resampling.resamples(); ++number) {
        const RankedCounts drawn = ranked(resampling.weights(number));
        measures.ap.draws.push_back(average_precision(drawn).value_or(undefined));
        measures.auc.draws.push_back(area_under_roc(drawn).value_or(undefined));
    }
    const std::vector<double> once(runs.size(), 1.0);
    const RankedCounts sample = ranked(once);
    move_to(measures.ap, exact.ap, average_precision(sample));
    move_to(measures.auc, exact.auc, area_under_roc(sample));
}

/// F1 as a ratio of sums over runs: 2 found / (predicted + true).
Drawn draw_f1(const std::vector<LinkSummary>& runs, double threshold,
              const analysis::RunResampling& resampling) {
    const CountsAbove above = counts_above(runs, threshold);
    const auto of_run = [&](auto value) {
        std::vector<double> column;
        for (std::size_t run = 0; run < runs.size(); ++run)
            column.push_back(value(run));
        return column;
    };
    return draw_ratio(of_run([&](std::size_t run) { return 2.0 * above.found[run]; }),
                      of_run([&](std::size_t run) {
                          return above.predicted[run] + static_cast<double>(runs[run].true_links());
                      }),
                      resampling);
}

/// A mean over pairs from sums over runs, in units.
Drawn draw_mean(const std::vector<LinkSummary>& runs, std::uint64_t LinkSummary::*sum, double unit,
                const analysis::RunResampling& resampling) {
    return draw_ratio(
        column_of(runs, [&](const LinkSummary& run) { return static_cast<double>(run.*sum) * unit; }),
        column_of(runs, [](const LinkSummary& run) { return run.pairs(); }), resampling);
}

Drawn draw_ece(const std::vector<LinkSummary>& runs, const analysis::RunResampling& resampling) {
    Table excess(runs.size(), calibration_bins + 1);  // the last column counts pairs
    for (std::size_t run = 0; run < runs.size(); ++run) {
        for (std::size_t bin = 0; bin < calibration_bins; ++bin) {
            const LinkSummary::Calibration& calibration = runs[run].calibration[bin];
            excess.at(run, bin) =
                static_cast<double>(calibration.probability) * LinkSummary::probability_unit -
                static_cast<double>(calibration.linked);
            excess.at(run, calibration_bins) += static_cast<double>(calibration.pairs);
        }
    }
    std::vector<double> total;
    const auto error = [&](std::span<const double> weights) {
        excess.sum(weights, total);
        const double pairs = total.back();
        if (pairs == 0.0) return undefined;
        return std::accumulate(total.begin(), total.end() - 1, 0.0,
                               [](double so_far, double bin) { return so_far + std::abs(bin); }) /
               pairs;
    };
    Drawn drawn;
    for (std::size_t number = 0; number < resampling.resamples(); ++number)
        drawn.draws.push_back(error(resampling.weights(number)));
    const double sample = error(std::vector<double>(runs.size(), 1.0));
    if (std::isfinite(sample)) drawn.value = sample;
    return drawn;
}

}  // namespace

DrawnMeasures draw_measures(const std::vector<LinkSummary>& runs, double threshold,
                            const analysis::RunResampling& resampling) {
    DrawnMeasures measures;
    for (const LinkSummary& run : runs)
        measures.sum.add(run);
    const metrics::LinkQuality exact = link_quality(measures.sum, threshold);
    draw_rankings(runs, resampling, exact, measures);
    measures.f1 = draw_f1(runs, threshold, resampling);
    measures.log_loss = draw_mean(runs, &LinkSummary::log_loss, LinkSummary::log_loss_unit, resampling);
    measures.ece = draw_ece(runs, resampling);
    measures.brier = draw_mean(runs, &LinkSummary::brier, LinkSummary::brier_unit, resampling);
    return measures;
}

CountsAbove counts_above(const std::vector<LinkSummary>& runs, double threshold) {
    const std::uint32_t first = LinkGrid::bin_of(static_cast<float>(threshold));
    CountsAbove counts;
    for (const LinkSummary& run : runs) {
        double found = 0.0;
        double predicted = 0.0;
        for (const LinkSummary::Bin& bin : run.bins) {
            if (bin.bin < first) continue;
            found += static_cast<double>(bin.linked);
            predicted += static_cast<double>(bin.linked + bin.unlinked);
        }
        counts.found.push_back(found);
        counts.predicted.push_back(predicted);
    }
    return counts;
}

Drawn draw_ratio(const std::vector<double>& numerators, const std::vector<double>& denominators,
                 const analysis::RunResampling& resampling) {
    const auto ratio = [&](std::span<const double> weights) {
        const double below = std::inner_product(weights.begin(), weights.end(), denominators.begin(), 0.0);
        if (below == 0.0) return undefined;
        return std::inner_product(weights.begin(), weights.end(), numerators.begin(), 0.0) / below;
    };
    Drawn drawn;
    for (std::size_t number = 0; number < resampling.resamples(); ++number)
        drawn.draws.push_back(ratio(resampling.weights(number)));
    const double sample = ratio(std::vector<double>(numerators.size(), 1.0));
    if (std::isfinite(sample)) drawn.value = sample;
    return drawn;
}

}  // namespace clearway::links::detail
