#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/estimate.hpp"

namespace clearway::analysis {

/// Bootstrap distributions of small samples are too narrow: by sqrt((n - 1) / n), and because their tails are
/// normal instead of t.
enum class SmallSample : std::uint8_t {
    as_published,  ///< Efron 1987.
    /// End points are moved outwards to compensate for both (expanded percentile interval, Hesterberg 2015).
    expanded,
};

struct BootstrapConfig {
    std::size_t resamples = 2000;  ///< 2000: Efron and Tibshirani 1993, section 14.3, for BCa end points.
    std::uint64_t seed = 1;        ///< Equal seeds give equal intervals.
    double level = usual_level;
    SmallSample small_sample = SmallSample::expanded;
};

/// How often each row of a resample was drawn; the counts add up to the number of rows.
using RowCounts = std::span<const std::uint8_t>;

/// Resamples of `rows` independent rows, drawn once and shared by all statistics of that many rows. Equal
/// numbers of rows and equal configurations give equal resamples. Takes resamples x rows bytes. Immutable;
/// may be shared by threads.
class Resamples {
  public:
    explicit Resamples(std::size_t rows, const BootstrapConfig& config = {});

    std::size_t rows() const { return rows_; }
    const BootstrapConfig& config() const { return config_; }
    RowCounts counts(std::size_t resample) const { return {counts_.data() + resample * rows_, rows_}; }

  private:
    std::size_t rows_;
    BootstrapConfig config_;
    std::vector<std::uint8_t> counts_;
};

/// Statistic of the rows, each counted as often as it was drawn.
using RowStatistic = std::function<double(RowCounts counts)>;
/// Statistic of the means of columns.
using MeansStatistic = std::function<double(std::span<const double> means)>;

/// Bias-corrected and accelerated bootstrap interval (Efron 1987) of a statistic over independent rows, with
/// the acceleration from the jackknife. Nothing for fewer than three rows, or when the statistic does not
/// vary or is not finite in some resample. Calls `statistic` resamples + rows + 1 times.
std::optional<Interval> bootstrap_bca(const Resamples& resamples, const RowStatistic& statistic);
/// The same for a statistic of the means of `columns`, each with one value per row. Takes time in proportion
/// to resamples x rows x columns.
std::optional<Interval> bootstrap_bca(const Resamples& resamples,
                                      std::span<const std::span<const double>> columns,
                                      const MeansStatistic& statistic);
/// The same for the mean of one column.
std::optional<Interval> bootstrap_bca_of_mean(const Resamples& resamples, std::span<const double> values);

/// Gap closed = (sum of baseline - sum of condition) / (sum of baseline - sum of solo) over replications,
/// with its BCa interval. The spans have equal lengths. Nothing for empty spans, or when the baseline is not
/// slower than solo on average, so that there is no gap. `resamples` must have as many rows as the spans.
MaybeEstimate gap_closed(std::span<const double> condition, std::span<const double> baseline,
                         std::span<const double> solo, const Resamples& resamples);

/// The members of one replication, which are not independent: travel times of its vehicles, s. Vehicles
/// without one (they did not arrive) are counted and rank above all others.
struct Cluster {
    std::vector<double> values;
    std::size_t without_value = 0;
};
/// Quantile of all members of all clusters, with its BCa interval from resampling whole clusters: the
/// smallest value that at least `share` of all members do not exceed. Nothing if it falls among the members
/// without a value. `resamples` must have one row per cluster.
MaybeEstimate pooled_quantile(std::span<const Cluster> clusters, double share, const Resamples& resamples);

}  // namespace clearway::analysis
