#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "actuation/signal_watch.hpp"

namespace clearway::testing {
namespace {

using traffic::RequestStatus;
using traffic::SignalStage;

TEST(SignalStatus, tells_stage_and_links_of_a_hold_from_its_call_to_the_return) {
    ActuationBench bench;
    EXPECT_TRUE(bench.actuator.signals().empty()) << "nobody asked";
    bench.offer(signal_a, traffic::HoldGreen{west, {13, 12}}, 8.0);
    std::vector<SignalStage> stages;
    std::vector<std::uint16_t> held_at_the_end = west;
    while (bench.now.value < 600.0) {
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
        << "it stays listed while no other hold may begin, or it may be out of step";
    EXPECT_TRUE(held_at_the_end.empty());
    EXPECT_TRUE(bench.actuator.signals().empty());
}

TEST(SignalStatus, tells_whether_a_coordinated_signal_is_in_step) {
    actuation::ActuatorConfig config = fixed_clearance();
    config.preemption.emplace_back().delay_s = 5.0;
    ActuationBench bench(0.25, config);
    int waited = 0;
    int held = 0;
    watch(bench, 15.0, [&](ActuationBench& b) {
        for (const traffic::SignalStatus& signal : b.actuator.signals()) {
            const bool in_program = signal.stage == SignalStage::program;
            ++(in_program ? waited : held);
            EXPECT_EQ(signal.coordination,
                      in_program ? traffic::Coordination::in_step : traffic::Coordination::out_of_step);
        }
        hold_until(west, 1000.0)(b);
    });
    EXPECT_GT(waited, 10);
    EXPECT_GT(held, 10);
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

/// Every different status that the request of a vehicle is given, in order.
std::vector<RequestStatus> told(
    ActuationBench& bench, core::VehicleKey vehicle, double until_s,
    const std::vector<std::pair<core::VehicleKey, traffic::HoldGreen>>& requests) {
    std::vector<RequestStatus> statuses;
    watch(bench, until_s, [&](ActuationBench& b) {
        for (const traffic::SignalStatus& signal : b.actuator.signals()) {
            for (const traffic::SignalCall& call : signal.calls) {
                if (call.emergency == vehicle && (statuses.empty() || statuses.back() != call.status))
                    statuses.push_back(call.status);
            }
        }
        for (const auto& [emergency, hold] : requests)
            b.offer(signal_a, hold, 2.0, 0, "policy", emergency);
    });
    return statuses;
}

TEST(SignalStatus, tells_a_requestor_of_the_transition_the_grant_the_cap_and_the_lockout) {
    ActuationBench bench;
    const core::VehicleKey vehicle{1};
    EXPECT_EQ(told(bench, vehicle, 70.0, {{vehicle, traffic::HoldGreen{west}}}),
              (std::vector{RequestStatus::processing, RequestStatus::granted, RequestStatus::max_presence,
                           RequestStatus::reservice_locked}));
}

TEST(SignalStatus, tells_no_lockout_any_more_when_it_only_waits_for_a_gap) {
    ActuationBench bench;
    bench.add({"h", traffic::VehicleClass::human, {"north_a_A", "A_south_a"}, 0, 289.6 - 10.0, 8.0});
    double returned_s = 0.0;
    std::vector<std::pair<double, RequestStatus>> waiting;
    watch(bench, 60.0, [&](ActuationBench& b) {
        for (const traffic::SignalStatus& signal : b.actuator.signals()) {
            if (b.now.value < 10.0 || signal.stage != SignalStage::program) continue;
            if (returned_s == 0.0) returned_s = b.now.value;
            if (!signal.calls.empty()) waiting.emplace_back(b.now.value, signal.calls[0].status);
        }
        if (b.now.value < 8.0 || returned_s > 0.0) b.offer(signal_a, traffic::HoldGreen{west}, 0.5);
    });
    ASSERT_GT(waiting.size(), 40U);
    for (const auto& [time_s, status] : waiting)
        EXPECT_EQ(status, time_s < returned_s + 10.0 - 1e-9 ? RequestStatus::reservice_locked
                                                            : RequestStatus::processing)
            << time_s - returned_s;
    EXPECT_GE(waiting.back().first, returned_s + 11.0) << "it waits for up to 2 s";
}

TEST(SignalStatus, tells_a_requestor_that_another_comes_first) {
    ActuationBench bench;
    EXPECT_EQ(told(bench, core::VehicleKey{2}, 30.0,
                   {{core::VehicleKey{1}, traffic::HoldGreen{west}},
                    {core::VehicleKey{2}, traffic::HoldGreen{north}}}),
              (std::vector{RequestStatus::processing}));
}

}  // namespace
}  // namespace clearway::testing
