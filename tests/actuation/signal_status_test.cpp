#include <vector>

#include <gtest/gtest.h>

#include "actuation/signal_watch.hpp"

namespace clearway::testing {
namespace {

using traffic::SignalStage;

TEST(SignalStatus, tells_stage_and_links_of_a_hold_from_its_call_to_the_return) {
    ActuationBench bench;
    EXPECT_TRUE(bench.actuator.signals().empty()) << "nobody asked";
    bench.offer(signal_a, traffic::HoldGreen{west, {13, 12}}, 8.0);
    std::vector<SignalStage> stages;
    std::vector<std::uint16_t> held_at_the_end = west;
    while (bench.now.value < 40.0) {
        bench.step();
        const auto signals = bench.actuator.signals();
        if (signals.empty()) break;
        ASSERT_EQ(signals.size(), 1U);
        EXPECT_EQ(signals[0].signal, signal_a);
        if (!signals[0].calls.empty()) {
            EXPECT_EQ(signals[0].held, west);
            EXPECT_EQ(signals[0].calls[0].links, (std::vector<std::uint16_t>{12, 13}));
        } else {
            held_at_the_end = signals[0].held;
        }
        if (stages.empty() || stages.back() != signals[0].stage) stages.push_back(signals[0].stage);
    }
    EXPECT_EQ(stages, (std::vector<SignalStage>{SignalStage::transition, SignalStage::dwell,
                                                SignalStage::transition, SignalStage::program}))
        << "it stays listed while no other hold may begin";
    EXPECT_TRUE(held_at_the_end.empty());
    EXPECT_TRUE(bench.actuator.signals().empty());
}

TEST(SignalStatus, tells_that_a_hold_reached_its_longest_time) {
    ActuationBench bench;
    double capped_s = 0.0;
    watch(bench, 70.0, [&](ActuationBench& now) {
        hold_until(west, 1000.0)(now);
        const auto signals = now.actuator.signals();
        if (capped_s == 0.0 && !signals.empty() && signals[0].capped) capped_s = now.now.value;
    });
    EXPECT_NEAR(capped_s, 60.25, 0.3);
}

}  // namespace
}  // namespace clearway::testing
