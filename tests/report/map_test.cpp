#include "report/map.hpp"

#include <gmock/gmock.h>

namespace clearway::report {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Optional;

MapEdge edge(const std::string& id, double length_m, std::vector<std::size_t> to) {
    return {id, std::move(to), false, length_m, 10.0, {{0.0, 0.0}, {length_m, 0.0}}};
}

/// 0 -> 1 -> 3, and the longer way 0 -> 2 -> 3; 4 leads to 0 and nothing leads to it.
RoadMap diamond() {
    RoadMap map;
    map.edges = {edge("start", 100.0, {1, 2}), edge("short", 200.0, {3}), edge("long", 900.0, {3}),
                 edge("end", 50.0, {}), edge("behind", 70.0, {0})};
    return map;
}

TEST(TimesFrom, TakeTheFastestWayAndCountBothEnds) {
    const RoadMap map = diamond();
    EXPECT_THAT(times_from(map, {0}, {10.0, 20.0, 5.0, 7.0, 1.0}),
                ElementsAre(Optional(DoubleEq(10.0)), Optional(DoubleEq(30.0)), Optional(DoubleEq(15.0)),
                            Optional(DoubleEq(22.0)), Eq(std::nullopt)));
}

TEST(TimesFrom, SeveralStartsUseTheNearest) {
    const RoadMap map = diamond();
    EXPECT_THAT(times_from(map, {0, 1}, {10.0, 20.0, 90.0, 7.0, 1.0}),
                ElementsAre(Optional(DoubleEq(10.0)), Optional(DoubleEq(20.0)), Optional(DoubleEq(100.0)),
                            Optional(DoubleEq(27.0)), Eq(std::nullopt)));
}

TEST(Reach, UsesMeasuredTimesWhereVehiclesDroveAndLengthensTheOthersAlike) {
    const RoadMap map = diamond();
    // At the limit of 10 m/s the first edge takes 10 s: without the condition thrice that, with it twice.
    const auto reach = reach_of(map, {{0, 4, 30.0, 20.0}}, {0}, 240.0);
    ASSERT_TRUE(reach);
    EXPECT_DOUBLE_EQ(reach->baseline_delay, 3.0);
    EXPECT_DOUBLE_EQ(reach->condition_delay, 2.0);
    EXPECT_THAT(reach->edges[1].baseline_s, Optional(DoubleEq(30.0 + 3.0 * 20.0)));
    EXPECT_THAT(reach->edges[1].condition_s, Optional(DoubleEq(20.0 + 2.0 * 20.0)));
    EXPECT_TRUE(reach->edges[0].driven);
    EXPECT_FALSE(reach->edges[1].driven);
    EXPECT_EQ(reach->minutes, 2.0);
    EXPECT_DOUBLE_EQ(reach->baseline_m(map, 90.0), 300.0);
    EXPECT_DOUBLE_EQ(reach->condition_m(map, 90.0), 350.0);
}

TEST(Reach, WeighsDelaysByPassages) {
    const RoadMap map = diamond();
    const auto reach = reach_of(map, {{0, 3, 20.0, 10.0}, {1, 1, 20.0, 20.0}}, {0}, 10.0);
    EXPECT_DOUBLE_EQ(reach->baseline_delay, (3 * 20.0 + 20.0) / (3 * 10.0 + 20.0));
    EXPECT_DOUBLE_EQ(reach->condition_delay, 1.0);
    EXPECT_EQ(reach->minutes, 1.0);  // at least one
}

TEST(Reach, NeedsStartsAndTimes) {
    const RoadMap map = diamond();
    EXPECT_FALSE(reach_of(map, {}, {0}, 100.0));
    EXPECT_FALSE(reach_of(map, {{0, 4, 30.0, 20.0}}, {}, 100.0));
}

}  // namespace
}  // namespace clearway::report
