#include "server/pacer.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clearway::server {
namespace {

/// Runs that make their next step of so many seconds as soon as they may.
struct Runs {
    Pacer& pacer;
    std::vector<double> times_s, steps_s;

    void begin() {
        for (std::size_t run = 0; run < times_s.size(); ++run)
            pacer.reached(run, times_s[run]);
    }
    /// Lets real time pass in beats of 20 ms; returns the largest difference between two runs.
    double pass(double seconds) {
        constexpr double beat_s = 0.02;
        double apart_s = 0.0;
        for (double passed_s = 0.0; passed_s < seconds - beat_s / 2; passed_s += beat_s) {
            const double allowed_s = pacer.allow(beat_s);
            for (std::size_t run = 0; run < times_s.size(); ++run) {
                while (times_s[run] < allowed_s)
                    times_s[run] += steps_s[run];
                pacer.reached(run, times_s[run]);
            }
            const auto [least, most] = std::ranges::minmax(times_s);
            apart_s = std::max(apart_s, most - least);
        }
        return apart_s;
    }
};

TEST(Pacer, nothing_is_allowed_before_every_run_has_begun) {
    Pacer pacer(2, 1.0);
    EXPECT_EQ(pacer.allow(1.0), Pacer::waiting);
    pacer.reached(0, 100.0);
    EXPECT_EQ(pacer.allow(1.0), Pacer::waiting);
    pacer.reached(1, 100.0);
    EXPECT_DOUBLE_EQ(pacer.allow(0.5), 100.5);
}

TEST(Pacer, runs_go_at_the_speed_that_is_set) {
    for (const double speed : {0.5, 1.0, 10.0}) {
        Pacer pacer(1, speed);
        Runs runs{pacer, {100.0}, {0.1}};
        runs.begin();
        runs.pass(4.0);
        EXPECT_NEAR(runs.times_s[0], 100.0 + 4.0 * speed, 0.3 + 0.02 * speed) << speed;
    }
}

TEST(Pacer, a_new_speed_holds_from_now_on) {
    Pacer pacer(1, 1.0);
    Runs runs{pacer, {0.0}, {0.1}};
    runs.begin();
    runs.pass(2.0);
    pacer.set_speed(5.0);
    runs.pass(2.0);
    EXPECT_NEAR(runs.times_s[0], 12.0, 0.5);
}

TEST(Pacer, runs_stay_in_step_whatever_their_step_lengths) {
    for (const double speed : {0.0, 1.0, 30.0}) {
        Pacer pacer(2, speed);
        Runs runs{pacer, {0.0, 0.0}, {0.1, 0.5}};
        runs.begin();
        EXPECT_LE(runs.pass(5.0), Pacer::lead_s + 0.5) << speed;
        EXPECT_GT(runs.times_s[0], 4.0);
    }
}

TEST(Pacer, a_run_that_hangs_holds_the_other_within_the_lead) {
    Pacer pacer(2, 0.0);
    pacer.reached(0, 50.0);
    pacer.reached(1, 50.0);
    for (int i = 0; i < 100; ++i)
        EXPECT_LE(pacer.allow(1.0), 50.0 + Pacer::lead_s);
}

TEST(Pacer, a_run_that_is_over_holds_nobody_up) {
    Pacer pacer(2, 1.0);
    pacer.reached(0, 50.0);
    pacer.reached(1, 50.0);
    pacer.ended(0);
    pacer.reached(1, 60.0);
    EXPECT_DOUBLE_EQ(pacer.allow(0.5), 60.5);
}

TEST(Pacer, paused_runs_stand_still_until_they_may_go) {
    Pacer pacer(2, 1.0);
    Runs runs{pacer, {0.0, 0.0}, {0.1, 0.1}};
    runs.begin();
    runs.pass(1.0);
    pacer.pause();
    runs.pass(0.1);
    const std::vector<double> then_s = runs.times_s;
    runs.pass(10.0);
    EXPECT_EQ(runs.times_s, then_s);
    EXPECT_TRUE(pacer.paused());
    pacer.go();
    runs.pass(1.0);
    EXPECT_NEAR(runs.times_s[0], then_s[0] + 1.0, 0.3);
}

TEST(Pacer, a_single_step_is_one_step_of_every_run_and_then_a_pause) {
    Pacer pacer(2, 1.0);
    Runs runs{pacer, {0.0, 0.0}, {0.1, 0.1}};
    runs.begin();
    runs.pass(1.0);
    pacer.pause();
    runs.pass(0.1);
    for (int steps = 1; steps <= 3; ++steps) {
        const std::vector<double> then_s = runs.times_s;
        pacer.step();
        runs.pass(1.0);
        EXPECT_NEAR(runs.times_s[0], then_s[0] + 0.1, 1e-9);
        EXPECT_NEAR(runs.times_s[1], then_s[1] + 0.1, 1e-9);
        EXPECT_TRUE(pacer.paused());
    }
}

TEST(Pacer, a_step_before_the_runs_have_begun_only_pauses) {
    Pacer pacer(1, 1.0);
    pacer.step();
    EXPECT_EQ(pacer.allow(1.0), Pacer::waiting);
    pacer.reached(0, 5.0);
    EXPECT_EQ(pacer.allow(1.0), Pacer::waiting);
    pacer.step();
    EXPECT_NEAR(pacer.allow(1.0), 5.0, 2e-3);
}

}  // namespace
}  // namespace clearway::server
