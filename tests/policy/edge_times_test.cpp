#include "policy/edge_times.hpp"

#include <gtest/gtest.h>

#include "policy/way_test.hpp"

namespace clearway::testing {
namespace {

using policy::EdgeTimes;
using policy::EdgeTimesConfig;

class EdgeTimesTest : public WayTest {
  protected:
    roads::RouteSearch search{short_square(), roads::Driver::emergency};
    core::EdgeIndex side = edge("A0B0");
    double free_s = search.free_s(side);

    /// After looking at the scene for a minute.
    EdgeTimes seen(const EdgeTimesConfig& config) {
        EdgeTimes times(short_square(), search, config);
        for (int look = 0; look < 120; ++look) {
            now_s += 0.5;
            scene.belief().time = core::Seconds(now_s);
            times.see(scene.belief(), core::Seconds(0.5));
        }
        return times;
    }
};

TEST_F(EdgeTimesTest, AreFreeFlowAndTheMeanWaitOfTheProgramWhereNothingWasSeen) {
    const EdgeTimes times(short_square(), search, {});
    const roads::Signal& signal = short_square().signal(short_square().find_signal("B0").value());
    double cycle_s = 0.0;
    for (const roads::Phase& phase : signal.program)
        cycle_s += phase.duration_s;
    const double wait_s = times.at(side, 0.0, 1.0) - free_s;
    EXPECT_GT(wait_s, 1.0);
    EXPECT_LT(wait_s, cycle_s / 2.0);
    EXPECT_DOUBLE_EQ(times.at(edge("B1right1"), 0.0, 1.0), search.free_s(edge("B1right1"))) << "no signal";
    const EdgeTimes half(short_square(), search, {.signal_share = 0.5});
    EXPECT_DOUBLE_EQ(half.at(side, 0.0, 1.0) - free_s, 0.5 * wait_s);
    EXPECT_DOUBLE_EQ(times.at(side, 0.0, 2.0), free_s / 2.0 + wait_s) << "twice the limit where it is free";
}

TEST_F(EdgeTimesTest, RememberAQueueLessTheLongerItIsAgo) {
    add_queue();
    EdgeTimes times = seen({});
    const double usual_s = EdgeTimes(short_square(), search, {}).at(side, 0.0, 1.0);
    const double now = times.at(side, 0.0, 1.0);
    EXPECT_GT(now, usual_s + 30.0);
    EXPECT_LT(times.at(side, 300.0, 1.0), now) << "for whoever comes later";
    times.turn_to(core::Seconds(now_s + 3600.0));
    EXPECT_NEAR(times.at(side, 0.0, 1.0), usual_s, 0.1);
}

TEST_F(EdgeTimesTest, WaitForASignalThatIsAskedOnlyUntilItHasChanged) {
    const EdgeTimes asked(short_square(), search, {.are_asked = true});
    const double drive_s = free_s / 2.0;
    EXPECT_NEAR(asked.at(side, 0.0, 2.0), 10.0, 1e-9) << "at the line before it is green";
    EXPECT_NEAR(asked.at(side, 4.0, 2.0), 6.0, 1e-9);
    EXPECT_DOUBLE_EQ(asked.at(side, 60.0, 2.0), drive_s);
}

TEST_F(EdgeTimesTest, WaitAtASignalThatIsAskedForThoseBefore) {
    add_queue();
    const EdgeTimes asked = seen({.fade_s = 20.0, .are_asked = true});
    const EdgeTimes program = seen({.fade_s = 20.0});
    EXPECT_GT(asked.at(side, 0.0, 1.0),
              EdgeTimes(short_square(), search, {.are_asked = true}).at(side, 0.0, 1.0));
    EXPECT_LT(asked.at(side, 60.0, 1.0), program.at(side, 60.0, 1.0));
}

TEST_F(EdgeTimesTest, LetNobodyOvertakeByEnteringLater) {
    add_queue();
    for (const bool are_asked : {false, true}) {
        const EdgeTimes times = seen({.fade_s = 20.0, .are_asked = are_asked});
        double left_s = 0.0;
        for (double entered_s = 0.0; entered_s < 200.0; entered_s += 0.5) {
            const double leaves_s = entered_s + times.at(side, entered_s, 1.2);
            EXPECT_GE(leaves_s, left_s - 1e-9) << entered_s;
            EXPECT_GE(leaves_s - entered_s, free_s / 1.2 - 1e-9);
            left_s = leaves_s;
        }
    }
}

}  // namespace
}  // namespace clearway::testing
