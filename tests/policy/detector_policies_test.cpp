#include <gtest/gtest.h>

#include "policy/check_in_out.hpp"
#include "policy/line_of_sight.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

CrossingScene emergency_at(double place_m, std::vector<std::string> route = eastbound) {
    CrossingScene scene;
    scene.add({"e", VehicleClass::emergency, std::move(route), 1, place_m, 10.0});
    return scene;
}

std::vector<traffic::Lease> act(policy::Policy& policy, CrossingScene scene) {
    std::vector<traffic::Lease> leases;
    policy.act(scene.belief(), leases);
    return leases;
}

const core::SignalIndex first_signal = two_crossings().find_signal("A").value();
const core::SignalIndex second_signal = two_crossings().find_signal("B").value();

TEST(CheckInOut, calls_from_the_first_detector_to_the_second) {
    policy::CheckInOut policy({two_crossings()});
    EXPECT_TRUE(act(policy, emergency_at(line_m - 151.0)).empty());
    const auto leases = act(policy, emergency_at(line_m - 149.0));
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<core::SignalIndex>(leases[0].target), first_signal);
    EXPECT_EQ(std::get<traffic::HoldGreen>(leases[0].action).own_links, (std::vector<std::uint16_t>{13, 14}));
    // The way through the junction is 21 m long; the next edge begins behind it.
    EXPECT_TRUE(act(policy, emergency_at(1.0, {"A_B", "B_east"})).empty()) << "22 m behind the line";
}

TEST(CheckInOut, keeps_calling_until_the_second_detector_is_passed) {
    policy::CheckInOutConfig config;
    config.check_out_m = 30.0;
    policy::CheckInOut policy({two_crossings()}, config);
    ASSERT_EQ(act(policy, emergency_at(line_m - 100.0)).size(), 1U);
    EXPECT_EQ(act(policy, emergency_at(1.0, {"A_B", "B_east"})).size(), 1U) << "22 m behind the line";
    EXPECT_TRUE(act(policy, emergency_at(20.0, {"A_B", "B_east"})).empty()) << "41 m behind it";
}

TEST(CheckInOut, releases_when_the_vehicle_is_gone) {
    policy::CheckInOut policy({two_crossings()});
    ASSERT_EQ(act(policy, emergency_at(line_m - 100.0)).size(), 1U);
    EXPECT_TRUE(act(policy, CrossingScene()).empty());
}

TEST(LineOfSight, calls_within_range_and_beam_only) {
    policy::LineOfSight policy({two_crossings()});
    EXPECT_TRUE(act(policy, emergency_at(line_m - 301.0)).empty());
    const auto leases = act(policy, emergency_at(line_m - 299.0));
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<core::SignalIndex>(leases[0].target), first_signal);
}

TEST(LineOfSight, does_not_see_a_signal_behind_a_bend) {
    policy::LineOfSight policy({two_crossings()});
    // From the north the way turns left at A: B lies 90 degrees off.
    const auto leases = act(policy, emergency_at(200.0, {"north_a_A", "A_B", "B_east"}));
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<core::SignalIndex>(leases[0].target), first_signal);
}

TEST(LineOfSight, sees_two_signals_in_one_line) {
    policy::LineOfSightConfig config;
    config.range_m = 2000.0;
    policy::LineOfSight policy({two_crossings()}, config);
    const auto leases = act(policy, emergency_at(100.0));
    ASSERT_EQ(leases.size(), 2U);
    EXPECT_EQ(std::get<core::SignalIndex>(leases[1].target), second_signal);
}

}  // namespace
}  // namespace clearway::testing
