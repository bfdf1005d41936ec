#include <algorithm>
#include <cassert>

#include <boost/math/distributions/binomial.hpp>

#include "analysis/estimate.hpp"

namespace clearway::analysis {
namespace {

/// Lower confidence limit of the quantile, which lies above the quantile with probability `outside`.
/// Interpolated between the order statistics that bracket this probability, with weights that are exact for
/// the double exponential distribution (Nyblom 1992).
std::optional<double> lower_limit(std::span<const double> sorted, double share, double outside) {
    const auto n = static_cast<double>(sorted.size());
    const boost::math::binomial below(n, share);
    // For r = 1, 2, ...: the probability that order statistic r lies above the quantile, P(fewer than r
    // below).
    const auto above = [&](std::size_t rank) {
        return boost::math::cdf(below, static_cast<double>(rank - 1));
    };
    if (above(1) > outside) return std::nullopt;
    std::size_t rank = 1;
    while (rank + 1 < sorted.size() && above(rank + 1) <= outside)
        ++rank;
    const double here = above(rank);
    const double next = above(rank + 1);
    const auto r = static_cast<double>(rank);
    const double part =
        (outside - here) / (outside - here + r * (1.0 - share) * (next - outside) / ((n - r) * share));
    return sorted[rank - 1] + part * (sorted[rank] - sorted[rank - 1]);
}

}  // namespace

double median(std::span<const double> values) {
    return quantile(values, 0.5);
}

double quantile(std::span<const double> values, double share) {
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    return quantile_of_sorted(sorted, share);
}

double quantile_of_sorted(std::span<const double> sorted, double share) {
    assert(!sorted.empty() && share >= 0.0 && share <= 1.0);
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    const double part = place - static_cast<double>(below);
    return sorted[below] + part * (sorted[above] - sorted[below]);
}

std::optional<Interval> quantile_interval(std::span<const double> values, double share, double level) {
    assert(share > 0.0 && share < 1.0);
    if (values.size() < 2) return std::nullopt;
    const double outside = 0.5 * (1.0 - level);
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const auto low = lower_limit(sorted, share, outside);
    // The upper limit is the lower one of the mirrored sample.
    for (double& value : sorted)
        value = -value;
    std::ranges::reverse(sorted);
    const auto high = lower_limit(sorted, 1.0 - share, outside);
    if (!low || !high) return std::nullopt;
    return Interval{*low, -*high};
}

}  // namespace clearway::analysis
