// How often an interval holds the true value, over many simulated samples. Nominal 95 %: 94 to 96.
#include <cmath>

#include <gmock/gmock.h>

#include "analysis/bootstrap.hpp"
#include "core/random.hpp"

namespace clearway::analysis {
namespace {

const core::KeyedRandom draws(core::StudySeed{11}, core::Replication{0});

TEST(Coverage, OfTheTIntervalOfPairedDifferencesIsNominal) {
    constexpr int samples = 10000;
    for (const std::size_t n : {std::size_t{5}, std::size_t{20}}) {
        int held = 0;
        for (int sample = 0; sample < samples; ++sample) {
            std::vector<double> baseline(n);
            std::vector<double> condition(n);
            for (std::size_t row = 0; row < n; ++row) {
                const auto subject = static_cast<std::uint64_t>(sample) * 64 + row;
                baseline[row] = 300.0 + 80.0 * draws.normal(core::Purpose::demand, subject);
                condition[row] = baseline[row] - 12.0 + 9.0 * draws.normal(core::Purpose::driver, subject);
            }
            held += estimate_difference(condition, baseline)->interval->contains(-12.0) ? 1 : 0;
        }
        const double share = held / static_cast<double>(samples);
        EXPECT_GE(share, 0.94) << n;
        EXPECT_LE(share, 0.96) << n;
    }
}

TEST(Coverage, OfTenPairsAdjustedByFortyBaselinesIsNominalAndNarrowerThanOfTwentyPairs) {
    constexpr std::uint64_t samples = 10000;
    constexpr std::size_t pairs = 10;
    constexpr std::size_t baselines = 40;
    int held = 0;
    double adjusted_s = 0.0;
    double plain_s = 0.0;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
        std::vector<double> lost(baselines);
        std::vector<double> differences(2 * pairs);
        for (std::size_t row = 0; row < baselines; ++row) {
            const std::uint64_t subject = sample * 64 + row;
            lost[row] = 50.0 + 20.0 * draws.normal(core::Purpose::demand, subject);
            if (row < differences.size())  // R^2 of 0.88
                differences[row] = -0.8 * lost[row] + 6.0 * draws.normal(core::Purpose::driver, subject);
        }
        const std::span all(lost);
        const auto adjusted = estimate_adjusted(std::span(differences).first(pairs), all.first(pairs), all);
        held += adjusted->interval->contains(-40.0) ? 1 : 0;
        adjusted_s += adjusted->interval->half_width();
        plain_s += estimate_mean(differences)->interval->half_width();
    }
    const double share = held / static_cast<double>(samples);
    EXPECT_GE(share, 0.94);
    EXPECT_LE(share, 0.96);
    EXPECT_LT(adjusted_s, 0.95 * plain_s);
}

/// Share of intervals of the gap closed that hold its true value of 0.4. Travel times are skewed as queues
/// make them.
double coverage_of_gap_closed(std::size_t n, int samples, BootstrapConfig config) {
    int held = 0;
    for (int sample = 0; sample < samples; ++sample) {
        std::vector<double> baseline(n);
        std::vector<double> condition(n);
        const std::vector<double> solo(n, 60.0);
        for (std::size_t row = 0; row < n; ++row) {
            const auto subject = static_cast<std::uint64_t>(sample) * 64 + row;
            const double delay = 40.0 * std::exp(0.5 * draws.normal(core::Purpose::demand, subject));
            baseline[row] = 60.0 + delay;
            condition[row] = 60.0 + 0.6 * delay + 5.0 * draws.normal(core::Purpose::driver, subject);
        }
        config.seed = static_cast<std::uint64_t>(sample);
        const Resamples resamples(n, config);
        held += gap_closed(condition, baseline, solo, resamples)->interval->contains(0.4) ? 1 : 0;
    }
    return held / static_cast<double>(samples);
}

TEST(Coverage, OfTheBcaIntervalOfTheGapClosedIsNominal) {
    BootstrapConfig config;
    config.resamples = 999;
    for (const std::size_t n : {std::size_t{10}, std::size_t{30}}) {
        const double share = coverage_of_gap_closed(n, 3000, config);
        EXPECT_GE(share, 0.94) << n;
        EXPECT_LE(share, 0.96) << n;
        RecordProperty("share_" + std::to_string(n), std::to_string(share));
    }
}

/// Skewed values with the median 1: delays as queues make them.
double skewed(std::uint64_t subject) {
    return std::exp(0.8 * draws.normal(core::Purpose::demand, subject));
}

double coverage_of_quantile(std::size_t n, double share, double truth) {
    constexpr int samples = 10000;
    int held = 0;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
        std::vector<double> values(n);
        for (std::size_t row = 0; row < n; ++row)
            values[row] = skewed(sample * 512 + row);
        held += quantile_interval(values, share)->contains(truth) ? 1 : 0;
    }
    return held / static_cast<double>(samples);
}

TEST(Coverage, OfTheIntervalOfAMedianIsNominal) {
    for (const std::size_t n : {std::size_t{10}, std::size_t{20}, std::size_t{30}}) {
        const double share = coverage_of_quantile(n, 0.5, 1.0);
        EXPECT_GE(share, 0.94) << n;
        EXPECT_LE(share, 0.96) << n;
    }
}

TEST(Coverage, OfTheIntervalOfA95thPercentileIsNominal) {
    for (const std::size_t n : {std::size_t{80}, std::size_t{200}}) {
        const double share = coverage_of_quantile(n, 0.95, std::exp(0.8 * 1.6448536));
        EXPECT_GE(share, 0.94) << n;
        EXPECT_LE(share, 0.96) << n;
    }
}

struct BoundedCoverage {
    double not_negative = 0.0;
    double t = 0.0;
    bool ever_below_zero = false;
};

/// Of the mean of values of which a share is 0 and the rest exponential with mean 1.
BoundedCoverage coverage_near_zero(std::size_t n, double share_above) {
    constexpr int samples = 4000;
    BoundedCoverage coverage;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
        std::vector<double> values(n);
        for (std::size_t row = 0; row < n; ++row) {
            const std::uint64_t subject = sample * 64 + row;
            const bool above = draws.uniform(core::Purpose::demand, subject) < share_above;
            values[row] = above ? -std::log(1.0 - draws.uniform(core::Purpose::driver, subject)) : 0.0;
        }
        const Interval interval = *estimate_not_negative(values)->interval;
        coverage.ever_below_zero |= interval.low < 0.0;
        coverage.not_negative += interval.contains(share_above) ? 1.0 / samples : 0.0;
        coverage.t += estimate_mean(values)->interval->contains(share_above) ? 1.0 / samples : 0.0;
    }
    return coverage;
}

TEST(Coverage, OfTheIntervalThatKeepsAboveZeroIsBetterThanOfTAndNeverBelowZero) {
    struct Case {
        std::size_t n;
        double share_above, least_held, least_gain;
    };
    for (const Case& one : {Case{5, 0.5, 0.88, 0.08}, Case{10, 0.5, 0.91, 0.05}, Case{20, 0.2, 0.89, 0.08},
                            Case{30, 0.2, 0.90, 0.05}, Case{30, 1.0, 0.91, 0.0}}) {
        const BoundedCoverage coverage = coverage_near_zero(one.n, one.share_above);
        EXPECT_FALSE(coverage.ever_below_zero) << one.n;
        EXPECT_GE(coverage.not_negative, one.least_held) << one.n << " " << one.share_above;
        EXPECT_GE(coverage.not_negative - coverage.t, one.least_gain) << one.n << " " << one.share_above;
    }
}

TEST(NotNegative, IsTheTIntervalWhereThatStaysAboveZeroAndTheLogarithmsElsewhere) {
    const std::vector<double> far = {10.0, 11.0, 12.0, 9.0, 10.5};
    EXPECT_EQ(estimate_not_negative(far)->interval->low, estimate_mean(far)->interval->low);
    EXPECT_EQ(estimate_not_negative(far)->interval->high, estimate_mean(far)->interval->high);
    // Mean 0.5, deviation sqrt(1.25): half width 2.776445 * 0.5 = 1.388, and exp(1.388 / 0.5) = 16.06.
    const std::vector<double> near = {0.0, 0.0, 2.5, 0.0, 0.0};
    EXPECT_NEAR(estimate_not_negative(near)->interval->low, 0.5 / 16.06, 1e-4);
    EXPECT_NEAR(estimate_not_negative(near)->interval->high, 0.5 * 16.06, 0.01);
    const std::vector<double> none(5, 0.0);
    EXPECT_EQ(estimate_not_negative(none)->interval->high, 0.0);
}

/// A Poisson variable by inversion.
double poisson(double mean, double uniform) {
    double probability = std::exp(-mean);
    double sum = probability;
    double value = 0.0;
    while (uniform > sum && value < 1000.0)
        sum += probability *= mean / ++value;
    return value;
}

/// Pairs of counts that share a replication's luck: negative binomial with `size` 1, or Poisson for 0.
struct CountPairs {
    std::vector<double> condition, baseline;

    CountPairs(std::size_t n, double mean, int size, std::uint64_t sample) {
        for (std::size_t row = 0; row < n; ++row) {
            const std::uint64_t subject = sample * 64 + row;
            const double luck =
                size == 0 ? 1.0 : -std::log(1.0 - draws.uniform(core::Purpose::demand, subject));
            condition.push_back(poisson(mean * luck, draws.uniform(core::Purpose::driver, subject)));
            baseline.push_back(poisson(mean * luck, draws.uniform(core::Purpose::bootstrap, subject)));
        }
    }
};

struct CountCoverage {
    double mean = 0.0;
    double difference = 0.0;
    bool ever_below_zero = false;
};

CountCoverage coverage_of_counts(std::size_t n, double mean, int size) {
    constexpr int samples = 3000;
    CountCoverage coverage;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
        const CountPairs pairs(n, mean, size, sample);
        const Interval interval = *estimate_count(pairs.condition)->interval;
        coverage.mean += interval.contains(mean) ? 1.0 / samples : 0.0;
        coverage.ever_below_zero |= interval.low < 0.0;
        coverage.difference +=
            estimate_count_difference(pairs.condition, pairs.baseline)->interval->contains(0.0)
                ? 1.0 / samples
                : 0.0;
    }
    return coverage;
}

TEST(Coverage, OfTheIntervalsOfCountsIsNominalAndOfRareOnesOnTheSafeSide) {
    constexpr double within_sampling_error_of_94 = 0.94 - 0.0043;  // one standard error of 3,000 samples
    for (const std::size_t n : {std::size_t{20}, std::size_t{30}}) {
        for (const double mean : {0.1, 0.3, 1.0, 4.0, 20.0}) {
            for (const int size : {0, 1}) {
                const CountCoverage coverage = coverage_of_counts(n, mean, size);
                const bool rare = mean < 1.0;
                const std::string which = "n " + std::to_string(n) + ", mean " + std::to_string(mean) +
                                          (size == 0 ? ", Poisson" : ", overdispersed");
                EXPECT_GE(coverage.mean, within_sampling_error_of_94) << which;
                EXPECT_LE(coverage.mean, rare ? 1.0 : 0.975) << which;
                EXPECT_GE(coverage.difference, within_sampling_error_of_94) << which;
                EXPECT_LE(coverage.difference, rare ? 1.0 : 0.98) << which;
                EXPECT_FALSE(coverage.ever_below_zero) << which;
            }
        }
    }
}

TEST(Coverage, OfThePooledMedianOverClustersIsNominal) {
    // Replications of six vehicles that share half of their luck.
    constexpr int samples = 1500;
    constexpr std::size_t n = 20;
    int held = 0;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
        std::vector<Cluster> clusters(n);
        for (std::size_t row = 0; row < n; ++row) {
            const std::uint64_t subject = sample * 64 + row;
            const double shared = draws.normal(core::Purpose::demand, subject);
            for (std::uint64_t vehicle = 0; vehicle < 6; ++vehicle)
                clusters[row].values.push_back(
                    100.0 + 20.0 * (shared + draws.normal(core::Purpose::driver, subject * 8 + vehicle)));
        }
        BootstrapConfig config;
        config.resamples = 999;
        config.seed = sample;
        held += pooled_quantile(clusters, 0.5, Resamples(n, config))->interval->contains(100.0) ? 1 : 0;
    }
    EXPECT_GE(held / static_cast<double>(samples), 0.94);
    EXPECT_LE(held / static_cast<double>(samples), 0.965);
}

}  // namespace
}  // namespace clearway::analysis
