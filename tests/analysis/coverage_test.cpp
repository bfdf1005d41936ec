// How often an interval holds the true value, over many simulated samples. Nominal 95 %: 94 to 96.
#include <cmath>

#include <gmock/gmock.h>

#include "analysis/estimate.hpp"
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
        held += gap_closed(condition, baseline, solo, config)->interval->contains(0.4) ? 1 : 0;
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

}  // namespace
}  // namespace clearway::analysis
