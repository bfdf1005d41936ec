#include <algorithm>
#include <cassert>
#include <cmath>

#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "analysis/estimate.hpp"

namespace clearway::analysis {
namespace {

using boost::math::complement;
using boost::math::gamma_distribution;

/// Tail probability of the normal distribution beyond the t quantile of `outside`.
double widened(double outside, double degrees_of_freedom) {
    const double t = boost::math::quantile(boost::math::students_t(degrees_of_freedom), outside);
    return boost::math::cdf(boost::math::normal(), t);
}

/// Fewer pairs with an event do not tell how two counts go together: one pair alone would make it certain.
constexpr std::ptrdiff_t fewest_with_events = 5;

/// Pearson correlation of two samples; 0 if one does not vary, or where too few pairs have an event.
double correlation(std::span<const double> first, std::span<const double> second, const Estimate& of_first,
                   const Estimate& of_second) {
    std::ptrdiff_t with_events = 0;
    double sum = 0.0;
    for (std::size_t row = 0; row < first.size(); ++row) {
        with_events += first[row] > 0.0 || second[row] > 0.0 ? 1 : 0;
        sum += (first[row] - of_first.mean) * (second[row] - of_second.mean);
    }
    if (with_events < fewest_with_events) return 0.0;
    const double scale = of_first.deviation * of_second.deviation * static_cast<double>(first.size() - 1);
    return scale > 0.0 ? sum / scale : 0.0;
}

/// Distance between the difference and its limit, from the distances of the two means to their limits.
double recovered(double from_first, double from_second, double correlation) {
    const double square =
        from_first * from_first + from_second * from_second - 2.0 * correlation * from_first * from_second;
    return std::sqrt(std::max(0.0, square));
}

}  // namespace

MaybeEstimate estimate_count(std::span<const double> counts, double level) {
    auto estimate = estimate_mean(counts, level);
    if (!estimate || !estimate->interval) return estimate;
    const auto n = static_cast<double>(estimate->n);
    const double variance = estimate->deviation * estimate->deviation;
    const double dispersion = estimate->mean > 0.0 ? std::max(1.0, variance / estimate->mean) : 1.0;
    const double nominal = 0.5 * (1.0 - level);
    const double outside = dispersion > 1.0 ? widened(nominal, n - 1.0) : nominal;
    const double total = estimate->mean * n / dispersion;
    const double scale = dispersion / n;
    estimate->interval->low =
        total > 0.0 ? scale * boost::math::quantile(gamma_distribution<>(total), outside) : 0.0;
    estimate->interval->high =
        scale * boost::math::quantile(complement(gamma_distribution<>(total + 1.0), outside));
    return estimate;
}

MaybeEstimate estimate_count_difference(std::span<const double> condition, std::span<const double> baseline,
                                        double level) {
    assert(condition.size() == baseline.size());
    auto difference = estimate_difference(condition, baseline, level);
    if (!difference || !difference->interval) return difference;
    const Estimate with = *estimate_count(condition, level);
    const Estimate without = *estimate_count(baseline, level);
    const double together = correlation(condition, baseline, with, without);
    difference->interval =
        Interval{difference->mean - recovered(with.mean - with.interval->low,
                                              without.interval->high - without.mean, together),
                 difference->mean + recovered(with.interval->high - with.mean,
                                              without.mean - without.interval->low, together)};
    return difference;
}

}  // namespace clearway::analysis
