#include "policy/detail/gap_search.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/ascii_scene.hpp"

namespace clearway::testing {
namespace {

using policy::detail::Gap;

/// The nearest gap on lane 0 for `e1` on lane 1. Cars: 5 m long, minimum gap 2.5 m.
std::optional<Gap> gap_on_lower_lane(const support::Scene& scene) {
    const traffic::BelievedGraph belief = support::perfect_belief(scene);
    const policy::detail::View view(scene.network(), belief);
    const traffic::BelievedVehicle& own = *belief.find(scene.key("e1"));
    const core::EdgeIndex edge = scene.network().lane(own.state.lane).edge;
    return policy::detail::nearest_gap(view, own, scene.network().lane_of(edge, 0), {});
}

TEST(GapSearch, finds_room_everywhere_on_an_empty_lane) {
    const support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        .....e.............
        ...................
    )");
    const auto gap = gap_on_lower_lane(scene);
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->shift_m, 0.0);
    EXPECT_EQ(gap->behind, nullptr);
}

TEST(GapSearch, leaves_the_headway_and_the_minimum_gap_behind_the_one_before) {
    const support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        .....e.............
        ......h............
    )");
    const auto gap = gap_on_lower_lane(scene);
    ASSERT_TRUE(gap);
    EXPECT_NEAR(gap->shift_m, 10.0 - 5.0 - 2.5 - 10.0, 1e-5)
        << "10 m ahead, 5 m long, gap 2.5 m, 1 s at 10 m/s";
    EXPECT_NEAR(gap->flow_mps, 10.0, 1e-5);
}

TEST(GapSearch, asks_less_headway_of_an_automated_follower_than_of_a_human_one) {
    const auto shift_before = [](const char* follower) {
        const support::Scene scene(fmt::format(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        .....e.............
        .....{}.............
    )",
                                               follower));
        return gap_on_lower_lane(scene)->shift_m;
    };
    // Behind is nearer than before: the length of the follower, 5 m, is less than the emergency vehicle's.
    const double human_m = shift_before("h");
    const double automated_m = shift_before("a");
    EXPECT_NEAR(human_m, -17.5, 1e-5) << "behind it: 5 m, gap 2.5 m, 1 s at 10 m/s";
    EXPECT_LT(std::abs(automated_m), std::abs(human_m)) << "before it: half a second only";
}

TEST(GapSearch, finds_nothing_in_a_row_without_gaps_but_its_ends) {
    const support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        .....e.............
        ....h.hh.h.........
    )");
    const auto gap = gap_on_lower_lane(scene);
    ASSERT_TRUE(gap);
    EXPECT_NEAR(gap->shift_m, -10.0 - 17.5, 1e-5) << "behind the last";
    EXPECT_EQ(gap->behind, nullptr);
}

TEST(GapSearch, does_not_take_the_own_vehicle_for_traffic_where_others_believe_it_elsewhere) {
    const support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        .....e.............
        ...................
    )");
    traffic::BelievedGraph belief = support::perfect_belief(scene);
    const traffic::BelievedVehicle own = *belief.find(scene.key("e1"));
    const core::EdgeIndex edge = scene.network().lane(own.state.lane).edge;
    const core::LaneIndex lower = scene.network().lane_of(edge, 0);
    belief.vehicles.front().state.lane = lower;
    const policy::detail::View view(scene.network(), belief);
    const auto gap = policy::detail::nearest_gap(view, own, lower, {});
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->shift_m, 0.0);
}

/// The lane that an automated vehicle on the middle one of three is to take.
std::optional<std::uint32_t> way_out(const char* upper, const char* lower) {
    const support::Scene scene(fmt::format(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        {}
        ...a...............
        {}
    )",
                                           upper, lower));
    const traffic::BelievedGraph belief = support::perfect_belief(scene);
    std::vector<policy::detail::VehicleAhead> others;
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles)
        others.push_back({&vehicle, 0.0});
    constexpr double side_room_m = 15.0;
    return policy::detail::View(scene.network(), belief)
        .way_out(*belief.find(scene.key("a1")), others, side_room_m);
}

TEST(WayOut, is_the_neighbouring_lane_with_fewer_vehicles_alongside_and_the_outer_one_if_equal) {
    EXPECT_EQ(way_out("...................", "..................."), 0U);
    EXPECT_EQ(way_out("...h...............", "...h..............."), 0U) << "a tie";
    EXPECT_EQ(way_out("...................", "..h................"), 2U);
    EXPECT_EQ(way_out("..h................", "...hh.............."), 2U);
    EXPECT_EQ(way_out("..h................", ".h...h............."), 0U) << "20 m away is not alongside";
}

}  // namespace
}  // namespace clearway::testing
