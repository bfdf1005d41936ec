#include "analysis/bootstrap.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "core/random.hpp"

namespace clearway::analysis {
namespace {

const boost::math::normal standard_normal;
constexpr std::size_t fewest_rows = 3;

/// A statistic of the sample, of each resample, and of the sample without each row.
struct Replicates {
    double observed = 0.0;
    std::vector<double> resampled;
    std::vector<double> without;
};

/// Efron and Tibshirani 1993, equation (14.15).
double acceleration_of(const std::vector<double>& without) {
    const auto rows = static_cast<double>(without.size());
    const double mean = std::accumulate(without.begin(), without.end(), 0.0) / rows;
    double squares = 0.0;
    double cubes = 0.0;
    for (const double value : without) {
        const double difference = mean - value;
        squares += difference * difference;
        cubes += difference * difference * difference;
    }
    return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

/// Equation (14.14): the share of the distribution below the observed value, with ties counting half, as a
/// normal quantile.
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

std::optional<Interval> bca_interval(Replicates replicates, const BootstrapConfig& config) {
    std::vector<double>& values = replicates.resampled;
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return std::nullopt;
    std::ranges::sort(values);
    if (values.front() == values.back()) return std::nullopt;
    const double bias = bias_of(values, replicates.observed);
    const double acceleration = acceleration_of(replicates.without);
    const double outside = outside_share(replicates.without.size(), config);
    return Interval{quantile_of_sorted(values, corrected_share(outside, bias, acceleration)),
                    quantile_of_sorted(values, corrected_share(1.0 - outside, bias, acceleration))};
}

double sum_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Sum of values, each as often as its row was drawn. Four partial sums make the additions independent,
/// because a bootstrap spends its time here.
double sum_of(std::span<const double> values, RowCounts counts) {
    std::array<double, 4> sums = {};
    std::size_t row = 0;
    for (; row + sums.size() <= values.size(); row += sums.size()) {
        for (std::size_t lane = 0; lane < sums.size(); ++lane)
            sums[lane] += static_cast<double>(counts[row + lane]) * values[row + lane];
    }
    for (; row < values.size(); ++row)
        sums[0] += static_cast<double>(counts[row]) * values[row];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// Values of all members in ascending order, each with its cluster.
struct Pool {
    std::vector<std::pair<double, std::uint32_t>> members;
    std::vector<double> sizes;  ///< Members of each cluster, with and without a value.
};

Pool pool_of(std::span<const Cluster> clusters) {
    Pool pool;
    for (std::uint32_t number = 0; number < clusters.size(); ++number) {
        const Cluster& cluster = clusters[number];
        for (const double value : cluster.values)
            pool.members.emplace_back(value, number);
        pool.sizes.push_back(static_cast<double>(cluster.values.size() + cluster.without_value));
    }
    std::ranges::sort(pool.members);
    return pool;
}

/// Infinite if the quantile falls among the members without a value.
double quantile_of(const Pool& pool, double share, RowCounts counts) {
    const double wanted = share * sum_of(pool.sizes, counts) * (1.0 - 1e-12);
    std::uint64_t passed = 0;
    for (const auto& [value, cluster] : pool.members) {
        passed += counts[cluster];
        if (static_cast<double>(passed) >= wanted && passed > 0) return value;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace

Resamples::Resamples(std::size_t rows, const BootstrapConfig& config)
    : rows_(rows), config_(config), counts_(rows * config.resamples) {
    const core::KeyedRandom random(core::StudySeed{config.seed}, core::Replication{0});
    for (std::size_t number = 0; number < config.resamples; ++number) {
        std::uint8_t* const counts = counts_.data() + number * rows;
        for (std::size_t draw = 0; draw < rows; ++draw)
            ++counts[random.below(rows, core::Purpose::bootstrap, number, draw)];
    }
}

std::optional<Interval> bootstrap_bca(const Resamples& resamples, const RowStatistic& statistic) {
    const std::size_t rows = resamples.rows();
    if (rows < fewest_rows) return std::nullopt;
    Replicates replicates;
    std::vector<std::uint8_t> counts(rows, 1);
    replicates.observed = statistic(counts);
    for (std::size_t number = 0; number < resamples.config().resamples; ++number)
        replicates.resampled.push_back(statistic(resamples.counts(number)));
    for (std::uint8_t& left_out : counts) {
        left_out = 0;
        replicates.without.push_back(statistic(counts));
        left_out = 1;
    }
    return bca_interval(std::move(replicates), resamples.config());
}

std::optional<Interval> bootstrap_bca(const Resamples& resamples,
                                      std::span<const std::span<const double>> columns,
                                      const MeansStatistic& statistic) {
    const std::size_t rows = resamples.rows();
    if (rows < fewest_rows) return std::nullopt;
    const auto n = static_cast<double>(rows);
    Replicates replicates;
    std::vector<double> totals;
    for (const std::span<const double> column : columns) {
        assert(column.size() == rows);
        totals.push_back(sum_of(column));
    }
    std::vector<double> means(columns.size());
    const auto evaluate = [&](auto&& mean) {
        for (std::size_t column = 0; column < columns.size(); ++column)
            means[column] = mean(column);
        return statistic(means);
    };
    replicates.observed = evaluate([&](std::size_t column) { return totals[column] / n; });
    for (std::size_t number = 0; number < resamples.config().resamples; ++number) {
        const RowCounts counts = resamples.counts(number);
        replicates.resampled.push_back(
            evaluate([&](std::size_t column) { return sum_of(columns[column], counts) / n; }));
    }
    for (std::size_t row = 0; row < rows; ++row)
        replicates.without.push_back(evaluate(
            [&](std::size_t column) { return (totals[column] - columns[column][row]) / (n - 1.0); }));
    return bca_interval(std::move(replicates), resamples.config());
}

std::optional<Interval> bootstrap_bca_of_mean(const Resamples& resamples, std::span<const double> values) {
    return bootstrap_bca(resamples, {{values}}, [](std::span<const double> means) { return means[0]; });
}

MaybeEstimate gap_closed(std::span<const double> condition, std::span<const double> baseline,
                         std::span<const double> solo, const Resamples& resamples) {
    assert(condition.size() == baseline.size() && solo.size() == baseline.size());
    if (baseline.empty() || !(sum_of(baseline) > sum_of(solo))) return std::nullopt;
    const std::array columns = {condition, baseline, solo};
    const auto share = [](std::span<const double> means) {
        return (means[1] - means[0]) / (means[1] - means[2]);
    };
    const std::array totals = {sum_of(condition), sum_of(baseline), sum_of(solo)};
    return Estimate{baseline.size(), share(totals), 0.0, bootstrap_bca(resamples, columns, share)};
}

MaybeEstimate pooled_quantile(std::span<const Cluster> clusters, double share, const Resamples& resamples) {
    assert(clusters.size() == resamples.rows());
    const Pool pool = pool_of(clusters);
    const double observed = quantile_of(pool, share, std::vector<std::uint8_t>(clusters.size(), 1));
    if (!std::isfinite(observed)) return {};
    const auto statistic = [&](RowCounts counts) { return quantile_of(pool, share, counts); };
    return Estimate{clusters.size(), observed, 0.0, bootstrap_bca(resamples, statistic)};
}

}  // namespace clearway::analysis
