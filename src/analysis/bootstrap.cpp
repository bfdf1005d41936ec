#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "analysis/estimate.hpp"
#include "core/random.hpp"

namespace clearway::analysis {
namespace {

const boost::math::normal standard_normal;

/// The statistic of every resample, ascending.
std::vector<double> resample(std::size_t rows, const RowStatistic& statistic, const BootstrapConfig& config) {
    const core::KeyedRandom random(core::StudySeed{config.seed}, core::Replication{0});
    std::vector<std::size_t> drawn(rows);
    std::vector<double> values(config.resamples);
    for (std::size_t number = 0; number < config.resamples; ++number) {
        for (std::size_t row = 0; row < rows; ++row)
            drawn[row] = random.below(rows, core::Purpose::bootstrap, number, row);
        values[number] = statistic(drawn);
    }
    std::ranges::sort(values);
    return values;
}

/// Efron and Tibshirani 1993, equation (14.15).
double acceleration_of(std::size_t rows, const RowStatistic& statistic) {
    std::vector<double> without(rows);
    std::vector<std::size_t> others(rows - 1);
    for (std::size_t left_out = 0; left_out < rows; ++left_out) {
        for (std::size_t row = 0; row + 1 < rows; ++row)
            others[row] = row < left_out ? row : row + 1;
        without[left_out] = statistic(others);
    }
    const double mean = std::accumulate(without.begin(), without.end(), 0.0) / static_cast<double>(rows);
    double squares = 0.0;
    double cubes = 0.0;
    for (const double value : without) {
        const double difference = mean - value;
        squares += difference * difference;
        cubes += difference * difference * difference;
    }
    return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

/// Equation (14.14): how much of the distribution lies below the observed value, ties counting half, in
/// normal units.
double bias_of(const std::vector<double>& sorted, double observed) {
    const auto below = std::ranges::lower_bound(sorted, observed) - sorted.begin();
    const auto upto = std::ranges::upper_bound(sorted, observed) - sorted.begin();
    const auto n = static_cast<double>(sorted.size());
    const double share = 0.5 * static_cast<double>(below + upto) / n;
    return boost::math::quantile(standard_normal, std::clamp(share, 0.5 / n, 1.0 - 0.5 / n));
}

/// Equation (14.10): the share of the distribution below an end point.
double corrected_share(double share, double bias, double acceleration) {
    const double z = bias + boost::math::quantile(standard_normal, share);
    return boost::math::cdf(standard_normal, bias + z / (1.0 - acceleration * z));
}

/// Share of the distribution below the lower end point of an interval without bias and acceleration.
double outside_share(std::size_t rows, const BootstrapConfig& config) {
    const double outside = 0.5 * (1.0 - config.level);
    if (config.small_sample == SmallSample::as_published) return outside;
    const auto n = static_cast<double>(rows);
    const double t = boost::math::quantile(boost::math::students_t(n - 1.0), outside);
    return boost::math::cdf(standard_normal, t * std::sqrt(n / (n - 1.0)));
}

double mean_of(std::span<const double> values, std::span<const std::size_t> rows) {
    double sum = 0.0;
    for (const std::size_t row : rows)
        sum += values[row];
    return sum / static_cast<double>(rows.size());
}

}  // namespace

std::optional<Interval> bootstrap_bca(std::size_t rows, const RowStatistic& statistic,
                                      const BootstrapConfig& config) {
    constexpr std::size_t fewest_rows = 3;
    if (rows < fewest_rows) return std::nullopt;
    const std::vector<double> values = resample(rows, statistic, config);
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return std::nullopt;
    if (values.front() == values.back()) return std::nullopt;
    std::vector<std::size_t> all(rows);
    std::iota(all.begin(), all.end(), std::size_t{0});
    const double bias = bias_of(values, statistic(all));
    const double acceleration = acceleration_of(rows, statistic);
    const double outside = outside_share(rows, config);
    return Interval{quantile(values, corrected_share(outside, bias, acceleration)),
                    quantile(values, corrected_share(1.0 - outside, bias, acceleration))};
}

std::optional<GapClosed> gap_closed(std::span<const double> condition, std::span<const double> baseline,
                                    std::span<const double> solo, const BootstrapConfig& config) {
    assert(condition.size() == baseline.size() && solo.size() == baseline.size());
    const auto share = [&](std::span<const std::size_t> rows) {
        const double from = mean_of(baseline, rows);
        return (from - mean_of(condition, rows)) / (from - mean_of(solo, rows));
    };
    if (baseline.empty()) return std::nullopt;
    std::vector<std::size_t> all(baseline.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (!(mean_of(baseline, all) > mean_of(solo, all))) return std::nullopt;
    return GapClosed{share(all), bootstrap_bca(baseline.size(), share, config)};
}

}  // namespace clearway::analysis
