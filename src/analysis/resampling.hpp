#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/estimate.hpp"

namespace clearway::analysis {

/// A number with its interval.
struct Measured {
    std::optional<double> value;
    std::optional<Interval> interval;
};

/// Bootstrap over runs within strata (scenarios): each resample draws as many runs of every stratum as there
/// are, with replacement. One set of resamples serves all measures, so differences and ratios between
/// predictors are paired.
class RunResampling {
  public:
    struct Config {
        std::size_t resamples = 1000;  ///< 1000: Efron and Tibshirani 1993, chapter 13, for percentiles.
        std::uint64_t seed = 1;
        double level = usual_level;
    };
    /// `stratum_sizes` runs in each stratum; runs are numbered stratum by stratum.
    explicit RunResampling(const std::vector<std::size_t>& stratum_sizes)
        : RunResampling(stratum_sizes, Config()) {}
    RunResampling(const std::vector<std::size_t>& stratum_sizes, const Config& config);

    std::size_t runs() const { return runs_; }
    std::size_t resamples() const { return config_.resamples; }
    /// How often each run was drawn in a resample.
    std::span<const double> weights(std::size_t resample) const {
        return std::span(weights_).subspan(resample * runs_, runs_);
    }
    /// Percentile interval of the values of all resamples, with its end points moved outwards for few runs as
    /// in SmallSample::expanded (with the degrees of freedom of all strata). Nothing when a stratum has fewer
    /// than two runs, when all have fewer degrees of freedom than `fewest_for_interval` runs of one stratum,
    /// or when a value is not finite.
    std::optional<Interval> interval(std::vector<double> values) const;
    /// Two-sided p-value of the hypothesis that a measure with these values is 0: one minus the greatest
    /// level at which `interval` leaves 0 out. From the smaller share of values on one side of 0, counted
    /// with one value more than there are, and widened for few runs as the interval is. Nothing where that
    /// has no interval.
    std::optional<double> p(std::span<const double> values) const;

  private:
    Config config_;
    std::size_t runs_ = 0;
    double freedom_ = 0.0;  ///< Degrees of freedom of all strata.
    double stretch_ = 1.0;  ///< Factor on normal quantiles, for the bias of the smallest stratum's variance.
    std::optional<double> outside_;  ///< Share below the lower end; nothing if there can be no interval.
    std::vector<double> weights_;
};

}  // namespace clearway::analysis
