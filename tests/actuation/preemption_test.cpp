#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "actuation/signal_watch.hpp"
#include "traffic/signal.hpp"

namespace clearway::testing {
namespace {

using traffic::Preemption;

/// Settings of a condition, and parameters of signal A alone.
actuation::ActuatorConfig with(const Preemption& parameters) {
    actuation::ActuatorConfig config;
    config.lockout_s = 0.0;
    config.preemption = {parameters};
    return config;
}

/// When a hold of the west from `begins_s` to `ends_s` leaves the program, is shown, ends and is over, s; -1
/// for what does not happen within 200 s.
struct Course {
    double left_s = -1.0;
    double shown_s = -1.0;
    double ended_s = -1.0;
    double back_s = -1.0;
};

Course course_of(const actuation::ActuatorConfig& config, double begins_s, double ends_s, int priority = 0) {
    ActuationBench bench(0.25, config);
    Course course;
    while (bench.now.value < 200.0) {
        const double now_s = bench.now.value;
        if (now_s >= begins_s && now_s < ends_s)
            bench.offer(signal_a, traffic::HoldGreen{west}, 0.5, priority);
        bench.step();
        const std::string& state = bench.shown[0];
        const bool in_program = state == two_crossings().signal(signal_a).program[0].state;
        const bool shown = state.substr(12) == "GGGG";
        if (!in_program && course.left_s < 0.0) course.left_s = bench.now.value;
        if (shown && course.shown_s < 0.0) course.shown_s = bench.now.value;
        if (!shown && course.shown_s > 0.0 && course.ended_s < 0.0) course.ended_s = bench.now.value;
        if (in_program && course.left_s > 0.0 && course.back_s < 0.0) course.back_s = bench.now.value;
    }
    return course;
}

const std::map<Refusal, std::uint64_t>& refusals_of(ActuationBench& bench) {
    return bench.counts(LeaseKind::hold_green).refused;
}

TEST(Preemption, that_is_off_grants_nothing) {
    EXPECT_GT(course_of(with({}), 1.0, 30.0).shown_s, 0.0);
    EXPECT_LT(course_of(with({.enabled = 0}), 1.0, 30.0).left_s, 0.0);
    ActuationBench bench(0.25, with({.enabled = 0}));
    watch(bench, 5.0, hold_until(west, 5.0));
    EXPECT_EQ(refusals_of(bench).at(Refusal::preemption_off), 1U);
}

TEST(Preemption, of_one_signal_leaves_the_others_as_they_are) {
    ActuationBench bench(0.25, with({.enabled = 0}));
    const core::SignalIndex other{1};
    while (bench.now.value < 20.0) {
        bench.offer(other, traffic::HoldGreen{west}, 2.0);
        bench.step();
    }
    EXPECT_EQ(bench.shown[1].substr(12), "GGGG");
}

TEST(Preemption, begins_when_a_request_has_lasted_for_the_delay) {
    const double at_once_s = course_of(with({}), 1.0, 40.0).left_s;
    EXPECT_NEAR(course_of(with({.delay_s = 8.0}), 1.0, 40.0).left_s, at_once_s + 8.0, 1e-9);
    EXPECT_LT(course_of(with({.delay_s = 8.0}), 1.0, 8.0).left_s, 0.0) << "it ended before";
}

TEST(Preemption, of_a_green_that_has_just_begun_waits_for_its_minimum) {
    const auto ends_after_s = [](const Preemption& parameters) {
        ActuationBench bench(0.25, with(parameters));
        double ends_s = 0.0;
        watch(bench, 60.0, [&](ActuationBench& each) {
            if (each.now.value == 1.0) each.shown[0] = "rrrrGGGgrrrrGGGg";
            if (each.now.value >= 2.0) each.offer(signal_a, traffic::HoldGreen{north}, 2.0);
            if (ends_s == 0.0 && each.shown[0][5] == 'y') ends_s = each.now.value;
        });
        return ends_s - 1.0;
    };
    EXPECT_NEAR(ends_after_s({}), 5.0, 0.5);
    EXPECT_NEAR(ends_after_s({.minimum_green_s = 12.0}), 12.0, 0.5);
}

/// How long a crossing walks and then stays red before the vehicles that cross it get green, s.
std::pair<double, double> walk_and_clearance_s(const Preemption& parameters) {
    ActuationBench bench(0.25, with(parameters), footway());
    double ends_s = 0.0;
    double opens_s = 0.0;
    watch(bench, 80.0, [&](ActuationBench& each) {
        if (each.now.value < 1.0) each.shown[0] = "rrr";
        if (each.now.value == 1.0) each.shown[0] = "rrG";
        if (each.now.value >= 2.0) each.offer(signal_a, traffic::HoldGreen{{1}}, 2.0);
        if (each.now.value > 1.0 && ends_s == 0.0 && each.shown[0][2] == 'r') ends_s = each.now.value;
        if (ends_s > 0.0 && opens_s == 0.0 && each.shown[0][1] == 'G') opens_s = each.now.value;
    });
    return {ends_s - 1.0, opens_s - ends_s};
}

TEST(Preemption, keeps_the_walk_and_the_pedestrian_clearance_that_are_set) {
    const auto [usual_walk_s, usual_clearance_s] = walk_and_clearance_s({});
    EXPECT_NEAR(usual_walk_s, 7.0, 0.5);
    EXPECT_NEAR(usual_clearance_s, 5.0, 0.3);
    const auto [walk_s, clearance_s] = walk_and_clearance_s({.walk_s = 15.0, .pedestrian_clearance_s = 11.0});
    EXPECT_NEAR(walk_s, 15.0, 0.5);
    EXPECT_NEAR(clearance_s, 11.0, 0.3);
    EXPECT_NEAR(walk_and_clearance_s({.pedestrian_clearance_s = 2.0}).second, 5.0, 0.3)
        << "never less than the program";
}

TEST(Preemption, lasts_for_its_minimum_though_the_request_has_ended) {
    const Course usual = course_of(with({}), 1.0, 12.0);
    const Course longer = course_of(with({.minimum_duration_s = 30.0}), 1.0, 12.0);
    EXPECT_NEAR(usual.ended_s, 12.25, 1.0);
    EXPECT_NEAR(longer.ended_s, longer.left_s + 30.0, 1e-9);
}

TEST(Preemption, dwells_for_its_time_though_the_request_ended_during_the_yellow) {
    EXPECT_LT(course_of(with({}), 1.0, 2.0).shown_s, 0.0) << "without a dwell it turns back";
    const Course course = course_of(with({.dwell_s = 9.0}), 1.0, 2.0);
    EXPECT_GT(course.shown_s, 0.0);
    EXPECT_NEAR(course.ended_s - course.shown_s, 9.0, 1e-9);
}

TEST(Preemption, ends_at_the_maximum_presence_and_never_where_that_is_zero) {
    const Course capped = course_of(with({.maximum_presence_s = 20.0}), 1.0, 1000.0);
    EXPECT_NEAR(capped.ended_s - capped.left_s, 20.0, 1e-9);
    EXPECT_LT(course_of(with({.maximum_presence_s = 0.0}), 1.0, 1000.0).ended_s, 0.0);
    const Course shortest = course_of(with({.maximum_presence_s = 1.0}), 1.0, 1000.0);
    EXPECT_GT(shortest.left_s, 0.0);
    EXPECT_LT(shortest.shown_s, 0.0) << "it is over during the yellow";
    const Course usual = course_of(with({}), 1.0, 1000.0);
    EXPECT_NEAR(usual.ended_s - usual.left_s, 60.0, 1e-9) << "hold_cap_s";
}

TEST(Preemption, goes_back_to_its_exit_phase_whatever_a_policy_asks_for) {
    const auto phases = [](const Preemption& parameters) {
        ActuationBench bench(0.25, with(parameters));
        std::vector<std::optional<std::uint32_t>> found;
        while (bench.now.value < 30.0) {
            if (bench.now.value < 12.0) bench.offer(signal_a, traffic::HoldGreen{west}, 2.0);
            if (bench.now.value < 14.0)
                bench.offer(signal_a, traffic::AdjustGreen{north}, 2.0, 0, "recovery");
            for (const auto& restore : bench.only<traffic::RestoreProgram>(bench.step()))
                found.push_back(restore.phase);
        }
        return found;
    };
    EXPECT_EQ(phases({}).at(0), 0U) << "the policy's";
    EXPECT_EQ(phases({.exit_phase = 2}).at(0), 2U);
}

TEST(Preemption, that_is_locked_out_waits_after_the_last_one) {
    const auto gap_s = [](const Preemption& parameters) {
        ActuationBench bench(0.25, with(parameters));
        double back_s = 0.0;
        double again_s = 0.0;
        while (bench.now.value < 120.0) {
            const bool in_program = bench.shown[0] == two_crossings().signal(signal_a).program[0].state;
            if (bench.now.value > 10.0 && in_program && back_s == 0.0) back_s = bench.now.value;
            if (back_s > 0.0 && !in_program && again_s == 0.0) again_s = bench.now.value;
            if (bench.now.value < 8.0 || back_s > 0.0) bench.offer(signal_a, traffic::HoldGreen{west}, 2.0);
            bench.step();
        }
        return again_s - back_s;
    };
    EXPECT_NEAR(gap_s({.lockout_s = 35.0}), 35.0, 0.5);
    EXPECT_LT(gap_s({}), 10.0);
}

TEST(Preemption, serves_no_request_of_a_lower_priority) {
    EXPECT_LT(course_of(with({.priority = 3}), 1.0, 30.0, 2).left_s, 0.0);
    EXPECT_GT(course_of(with({.priority = 3}), 1.0, 30.0, 3).shown_s, 0.0);
}

}  // namespace
}  // namespace clearway::testing
