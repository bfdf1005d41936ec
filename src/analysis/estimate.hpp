#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace clearway::analysis {

// Pure functions on samples. Values are not checked for being finite.

/// Confidence interval; `low` <= `high`.
struct Interval {
    double low = 0.0;
    double high = 0.0;

    double half_width() const { return 0.5 * (high - low); }
    bool contains(double value) const { return low <= value && value <= high; }
};

/// Share of intervals that contain the true value, over many samples.
inline constexpr double usual_level = 0.95;

/// With fewer values no interval is printed: at four values a t interval is twice as wide as at ten, and with
/// skewed values it misses the true mean one time in four.
inline constexpr std::size_t fewest_for_interval = 5;

/// A mean, or another statistic, with its uncertainty.
struct Estimate {
    std::size_t n = 0;
    double mean = 0.0;
    double deviation = 0.0;  ///< Standard deviation of the sample, n - 1; 0 below two values and for others.
    std::optional<Interval> interval;  ///< Empty below two values.
};
using MaybeEstimate = std::optional<Estimate>;

/// The interval, if it rests on enough values to be printed; else null.
inline const Interval* shown_interval(const MaybeEstimate& estimate) {
    const bool shown = estimate && estimate->interval && estimate->n >= fewest_for_interval;
    return shown ? &*estimate->interval : nullptr;
}
inline std::optional<double> mean_of(const MaybeEstimate& estimate) {
    return estimate ? std::optional(estimate->mean) : std::nullopt;
}

/// Mean and t interval: mean +- t(n - 1) s / sqrt(n). Nothing for an empty sample.
MaybeEstimate estimate_mean(std::span<const double> values, double level = usual_level);

/// Mean of values that are never negative (durations, shares), with an interval that does not reach below 0:
/// the t interval if it stays above 0, else that of the logarithm of the mean, whose standard error is
/// s / (sqrt(n) mean) by the delta method: mean x exp(-+ t(n - 1) s / (sqrt(n) mean)). A t interval cut at 0
/// keeps its coverage, which is too low there because values near a bound are skewed. For 20 values of which
/// four in five are 0, it contains the true mean in 80 % of samples and this interval in 91 %; for 10 values
/// of which half are 0, 85 % against 93 % (tests/analysis/coverage_test.cpp). A BCa bootstrap of so few
/// values is no better than t. Nothing for an empty sample.
MaybeEstimate estimate_not_negative(std::span<const double> values, double level = usual_level);

/// Mean of `condition[i] - baseline[i]` with its t interval. The spans have equal lengths.
MaybeEstimate estimate_difference(std::span<const double> condition, std::span<const double> baseline,
                                  double level = usual_level);

/// The same as a share of the baseline's mean: difference and interval are divided by mean(baseline), which
/// is taken as known, so the interval ignores the uncertainty of that mean. Nothing when that mean is not
/// positive.
MaybeEstimate relative_difference(std::span<const double> condition, std::span<const double> baseline,
                                  double level = usual_level);

/// Mean of `values` where the mean of a covariate, which the sample has beside each value, is known better
/// from a larger sample `all`, that one included: the regression estimator of double sampling (Cochran,
/// Sampling Techniques, 1977, chapter 12), with a t interval by Satterthwaite's degrees of freedom, since the
/// residuals have n - 2 and `all` its own. `deviation` is that of the residuals. Nothing for fewer values
/// than `fewest_for_interval`, or where the covariate does not vary.
MaybeEstimate estimate_adjusted(std::span<const double> values, std::span<const double> covariate,
                                std::span<const double> all, double level = usual_level);

/// Sum of `sums` by sum of `counts`: a mean of what comes in clusters of different sizes, with the t interval
/// of the clusters' deviations from it (Cochran, Sampling Techniques, 1977, chapter 6). Clusters of count 0
/// do not count; n is the number of the others. The spans have equal lengths.
MaybeEstimate estimate_ratio(std::span<const double> sums, std::span<const double> counts,
                             double level = usual_level);

/// Median; mean of the two middle values for even n. `values` not empty.
double median(std::span<const double> values);
/// Quantile `share` in [0, 1] by linear interpolation between order statistics (Hyndman and Fan 1996, type
/// 7). `values` not empty.
double quantile(std::span<const double> values, double share);
/// The same for values which are already in ascending order.
double quantile_of_sorted(std::span<const double> sorted, double share);

/// Distribution-free interval of the population's quantile from order statistics, interpolated to reach its
/// level (Nyblom 1992; for the median Hettmansperger and Sheather 1986). `share` in (0, 1). Nothing for a
/// sample that is too small: at 95 % a median needs 6 values, a 95th percentile 72.
std::optional<Interval> quantile_interval(std::span<const double> values, double share,
                                          double level = usual_level);

/// Mean of counts (0, 1, 2, ...) with an interval that never reaches below 0: Garwood's exact Poisson
/// interval (1936) of total / phi, scaled by phi = max(1, variance / mean), with t instead of normal tails if
/// phi > 1. Simulated coverage: tests/analysis/coverage_test.cpp. Nothing for an empty sample.
MaybeEstimate estimate_count(std::span<const double> counts, double level = usual_level);

/// Mean of `condition[i] - baseline[i]` of counts; the interval follows from those of the two means by the
/// method of variance estimates recovery with their correlation (Zou and Donner 2008), which is 0 where fewer
/// than five pairs have an event, so that rare events do not look like certain differences. A bootstrap and a
/// t interval are too narrow for them: with four collisions against none they excluded 0.
MaybeEstimate estimate_count_difference(std::span<const double> condition, std::span<const double> baseline,
                                        double level = usual_level);

/// Mean of the paired differences divided by their standard deviation (Cohen's d for pairs, d_z). Nothing
/// below two pairs or without variation.
std::optional<double> effect_size(std::span<const double> condition, std::span<const double> baseline);

/// t(n - 1) s / sqrt(n): half the width of the interval of a mean of `n` >= 2 values with standard deviation
/// `deviation`.
double half_width(double deviation, std::size_t n, double level = usual_level);

/// No more are counted: what needs more cannot be told by runs.
inline constexpr std::size_t most_replications = std::size_t{1} << 24U;
/// Replications that an interval of half width `half_width` needs for a standard deviation of `deviation`:
/// the least n of at least 2 with n >= (t(n - 1) deviation / half_width)^2. FHWA, Traffic Analysis Toolbox
/// III (FHWA-HOP-18-036, 2019), section on the number of runs, its equation iterated because t depends on n.
/// `half_width` > 0, `deviation` >= 0, both in one unit. At most `most_replications`.
std::size_t required_replications(double deviation, double half_width, double level = usual_level);
/// How often a study is to show a difference that is there.
inline constexpr double usual_power = 0.8;
/// Pairs that show a mean difference with the usual power: the least n of at least 2 whose interval, and what
/// chance may take from the mean, t(n - 1) of the power times deviation / sqrt(n), fit into it (Cohen 1988,
/// his paired t test with the central distribution). `difference` > 0, `deviation` >= 0, both in one unit. At
/// most `most_replications`.
std::size_t replications_to_show(double deviation, double difference, double level = usual_level);
/// FHWA's minimum, whatever the equation says.
inline constexpr std::size_t fewest_replications = 10;
/// Those required, and at least the minimum.
inline std::size_t advised_replications(double deviation, double half_width, double level = usual_level) {
    return std::max(fewest_replications, required_replications(deviation, half_width, level));
}

/// Two-sided p value of Wilcoxon's signed-rank test on the paired differences: zeros are left out, ties get
/// their mean rank; exact for up to 25 differences that are not zero, else normal with continuity and tie
/// correction. Nothing when every difference is zero.
std::optional<double> wilcoxon_p(std::span<const double> condition, std::span<const double> baseline);

/// Two-sided p value of the paired t test. Nothing below two pairs or without variation.
std::optional<double> paired_t_p(std::span<const double> condition, std::span<const double> baseline);

/// p value of the paired equivalence test (two one-sided t tests, Schuirmann 1987): the greater of those
/// against "the mean difference is -margin or less" and "margin or more". Without variation 0 if the mean
/// lies within the margin, else 1. Nothing below two pairs. `margin` > 0.
std::optional<double> paired_equivalence_p(std::span<const double> condition,
                                           std::span<const double> baseline, double margin);

/// Holm's step-down adjustment, in the order of `p_values`; each at most 1.
std::vector<double> holm(std::span<const double> p_values);

/// GEH statistic of a modelled against a counted flow, both in vehicles per hour and >= 0:
/// sqrt(2 (m - c)^2 / (m + c)), 0 when both are 0 (DMRB volume 12, section 2, part 1, 4.4.42). Below 5 a flow
/// counts as matched; the usual criterion requires this at 85 % of the places.
double geh(double modelled_per_hour, double counted_per_hour);
inline constexpr double geh_limit = 5.0;

}  // namespace clearway::analysis
