#include "drivers/privilege.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"
#include "drivers/detail/gap_across.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::testing {
namespace {

using drivers::detail::Across;
using traffic::LateralModel;

std::vector<traffic::Command> step(drivers::Privilege& privilege, const support::Scene& scene) {
    std::vector<traffic::Command> commands;
    privilege.step(scene.snapshot(), scene.roster(), commands);
    return commands;
}

drivers::PrivilegeConfig red() {
    drivers::PrivilegeConfig config;
    config.pass_red = 1;
    return config;
}

drivers::PrivilegeConfig between() {
    drivers::PrivilegeConfig config;
    config.between_lanes = 1;
    return config;
}

TEST(Privilege, passes_red_slowly_and_ends_with_it) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        .....e....|r.............
    )");
    drivers::Privilege privilege(scene.network(), red(), LateralModel::lane);
    const auto commands = step(privilege, scene);
    const auto passes = ActuationBench::only<traffic::SetJunctionPrivilege>(commands);
    ASSERT_EQ(passes.size(), 1U);
    EXPECT_EQ(passes[0].privilege, traffic::JunctionPrivilege::pass_red);
    const auto speeds = ActuationBench::only<traffic::SetSpeed>(commands);
    ASSERT_EQ(speeds.size(), 1U);
    EXPECT_NEAR(speeds[0].speed.value, std::sqrt(5.56 * 5.56 + 2.0 * 2.0 * 45.0), 0.01) << "45 m to go";
    scene.snapshot().signals.state[0] = "Gr";
    const auto after = step(privilege, scene);
    ASSERT_EQ(after.size(), 2U);
    EXPECT_EQ(ActuationBench::only<traffic::ReleaseSpeed>(after).size(), 1U);
    EXPECT_EQ(ActuationBench::only<traffic::SetJunctionPrivilege>(after).at(0).privilege,
              traffic::JunctionPrivilege::none);
}

TEST(Privilege, is_of_emergency_vehicles_alone_and_of_those_near_a_red_signal) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        e.................................h....|r....
    )");
    drivers::Privilege privilege(scene.network(), red(), LateralModel::lane);
    EXPECT_TRUE(step(privilege, scene).empty()) << "385 m";
}

TEST(Privilege, that_is_not_granted_changes_nothing) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 2 m/s
        ..e..h....|r.............
    )");
    drivers::Privilege privilege(scene.network(), {}, LateralModel::sublane);
    EXPECT_TRUE(step(privilege, scene).empty());
}

/// Moves vehicles across the road: positive is left.
void shift(support::Scene& scene, const char* id, float metres) {
    scene.snapshot().y_m[scene.row(id)] += metres;
}

TEST(Privilege, steers_between_two_lanes_where_it_fits_and_slowly) {
    support::Scene scene(R"(
        10 m per cell, limit 30 m/s, speed 2 m/s
        ....h.......
        .e..h.......
    )");
    shift(scene, "h1", 0.7F);
    shift(scene, "h2", -0.7F);
    drivers::Privilege privilege(scene.network(), between(), LateralModel::sublane);
    const auto commands = step(privilege, scene);
    const auto steered = ActuationBench::only<traffic::SteerSideways>(commands);
    ASSERT_EQ(steered.size(), 1U);
    // Between y = 0.2 (left side of h2) and 3.0 (right side of h1) the vehicle, 1.8 m wide with 0.4 m of
    // margin, has its middle at 1.3 at least.
    EXPECT_NEAR(steered[0].shift.value, 1.3, 0.01);
    EXPECT_EQ(ActuationBench::only<traffic::SetLateralAlignment>(commands).at(0).alignment,
              traffic::LateralAlignment::free);
    EXPECT_NEAR(ActuationBench::only<traffic::SetSpeed>(commands).at(0).speed.value, 11.1, 1e-6);
    std::vector<traffic::Command> restored;
    privilege.restore_all(restored);
    EXPECT_EQ(ActuationBench::only<traffic::SetLateralAlignment>(restored).at(0).alignment,
              traffic::LateralAlignment::usual);
    EXPECT_EQ(ActuationBench::only<traffic::SetLaneChangeFreedom>(restored).at(0).freedom,
              traffic::LaneChangeFreedom::normal);
    EXPECT_EQ(ActuationBench::only<traffic::ReleaseSpeed>(restored).size(), 1U);
}

TEST(Privilege, stays_where_it_is_when_it_fits_nowhere) {
    support::Scene scene(R"(
        10 m per cell, limit 30 m/s, speed 2 m/s
        .e..h.......
    )");
    drivers::Privilege privilege(scene.network(), between(), LateralModel::sublane);
    const auto steered = ActuationBench::only<traffic::SteerSideways>(step(privilege, scene));
    ASSERT_EQ(steered.size(), 1U);
    EXPECT_DOUBLE_EQ(steered[0].shift.value, 0.0);
}

TEST(Privilege, does_not_leave_its_lane_without_the_sublane_model_or_without_slow_traffic) {
    support::Scene scene(R"(
        10 m per cell, limit 30 m/s, speed 2 m/s
        .e..h.......
    )");
    drivers::Privilege lane(scene.network(), between(), LateralModel::lane);
    EXPECT_TRUE(step(lane, scene).empty());
    scene.set_speed("h1", core::MetresPerSecond(29.0));
    drivers::Privilege free(scene.network(), between(), LateralModel::sublane);
    EXPECT_TRUE(step(free, scene).empty());
}

TEST(GapAcross, is_the_nearest_that_is_wide_enough) {
    const Across road{-5.0, 5.0};
    const auto free = drivers::detail::nearest_free(road, {{-1.5, 1.0}, {3.0, 4.8}}, 2.0);
    ASSERT_TRUE(free);
    EXPECT_DOUBLE_EQ(free->right_m, 1.0);
    EXPECT_DOUBLE_EQ(free->left_m, 3.0);
    EXPECT_DOUBLE_EQ(drivers::detail::shift_into(*free, 2.0), 2.0);
    const auto right = drivers::detail::nearest_free(road, {{-1.5, 1.0}, {2.0, 4.8}}, 2.0);
    EXPECT_DOUBLE_EQ(right->left_m, -1.5) << "the left one is 1 m wide";
    EXPECT_FALSE(drivers::detail::nearest_free(road, {{-4.0, 4.0}}, 2.0));
    EXPECT_DOUBLE_EQ(drivers::detail::nearest_free(road, {}, 2.0)->width_m(), 10.0);
}

}  // namespace
}  // namespace clearway::testing
