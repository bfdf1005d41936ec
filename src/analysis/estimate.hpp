#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace clearway::analysis {

// Pure functions on samples. Values are not checked for being finite. Nothing here prints or rounds.

/// Confidence interval; `low` <= `high`.
struct Interval {
    double low = 0.0;
    double high = 0.0;

    double half_width() const { return 0.5 * (high - low); }
    bool contains(double value) const { return low <= value && value <= high; }
};

/// Share of intervals that hold the true value, over many samples.
inline constexpr double usual_level = 0.95;

/// A mean with what is known of its uncertainty.
struct Estimate {
    std::size_t n = 0;
    double mean = 0.0;
    double deviation = 0.0;            ///< Standard deviation of the sample, n - 1; 0 below two values.
    std::optional<Interval> interval;  ///< Empty below two values.
};

/// Mean and t interval: mean +- t(n - 1) s / sqrt(n). Nothing for an empty sample.
std::optional<Estimate> estimate_mean(std::span<const double> values, double level = usual_level);

/// Mean of `condition[i] - baseline[i]` with its t interval. The spans have one length.
std::optional<Estimate> estimate_difference(std::span<const double> condition,
                                            std::span<const double> baseline, double level = usual_level);

/// The same as a share of the baseline's mean: difference and interval divided by mean(baseline), which is
/// taken as known; the interval is that of the difference, and says of the ratio's own uncertainty nothing.
/// Nothing when that mean is not positive.
std::optional<Estimate> relative_difference(std::span<const double> condition,
                                            std::span<const double> baseline, double level = usual_level);

/// Median; mean of the two middle values for even n. `values` not empty.
double median(std::span<const double> values);
/// Quantile `share` in [0, 1] by linear interpolation between order statistics (Hyndman and Fan 1996, type
/// 7). `values` not empty.
double quantile(std::span<const double> values, double share);

/// Mean of the paired differences over their standard deviation (Cohen's d for pairs, d_z). Nothing below two
/// pairs or without variation.
std::optional<double> effect_size(std::span<const double> condition, std::span<const double> baseline);

/// Two-sided p value of Wilcoxon's signed-rank test on the paired differences: zeros left out, ties at mean
/// rank; exact up to 25 differences without ties, else normal with continuity and tie correction. Nothing
/// when every difference is zero.
std::optional<double> wilcoxon_p(std::span<const double> condition, std::span<const double> baseline);

/// Two-sided p value of the paired t test. Nothing below two pairs or without variation.
std::optional<double> paired_t_p(std::span<const double> condition, std::span<const double> baseline);

/// Holm's step-down adjustment, in the order of `p_values`; each at most 1.
std::vector<double> holm(std::span<const double> p_values);

/// Statistic of a resample: receives row numbers, with repetitions.
using RowStatistic = std::function<double(std::span<const std::size_t>)>;

/// Bootstrap distributions of small samples are too narrow, by sqrt((n - 1) / n) and by normal instead of t
/// tails.
enum class SmallSample : std::uint8_t {
    as_published,  ///< Efron 1987.
    expanded,  ///< End points moved outwards to make up for both (expanded percentile interval, Hesterberg
               ///< 2015).
};

struct BootstrapConfig {
    std::size_t resamples = 2000;  ///< 2000: Efron and Tibshirani 1993, section 14.3, for BCa end points.
    std::uint64_t seed = 1;        ///< Equal seeds give equal intervals.
    double level = usual_level;
    SmallSample small_sample = SmallSample::expanded;
};
/// Bias-corrected and accelerated bootstrap interval (Efron 1987) of a statistic over `rows` independent
/// rows, the acceleration by jackknife. Nothing below three rows, or when the statistic does not vary.
std::optional<Interval> bootstrap_bca(std::size_t rows, const RowStatistic& statistic,
                                      const BootstrapConfig& config = {});

/// Gap closed = (sum of baseline - sum of condition) / (sum of baseline - sum of solo) over replications. The
/// spans have one length.
struct GapClosed {
    double value = 0.0;
    std::optional<Interval> interval;  ///< BCa over replications.
};
/// Nothing for empty spans, or where baseline is not slower than solo on average: no gap to close.
std::optional<GapClosed> gap_closed(std::span<const double> condition, std::span<const double> baseline,
                                    std::span<const double> solo, const BootstrapConfig& config = {});

}  // namespace clearway::analysis
