#include "policy/timed_holds.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "policy/check_in_out.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

/// Leases at a moment: what a detector asks for an emergency vehicle 100 m before A, then the timed holds.
class TimedHoldsTest : public ::testing::Test {
  protected:
    TimedHoldsTest() {
        vehicle = scene.add({"e", VehicleClass::emergency, eastbound, 1, line_m - 100.0, 14.0});
    }
    std::vector<traffic::Lease> leases_at(double time_s) {
        traffic::BelievedGraph& belief = scene.belief();
        belief.time = core::Seconds(time_s);
        std::vector<traffic::Lease> leases;
        detector.act(belief, leases);
        const auto left = timed.in_place_of(leases, belief, true);
        return {left.begin(), left.end()};
    }
    core::SignalIndex signal = two_crossings().find_signal("A").value();
    CrossingScene scene;
    core::VehicleKey vehicle;
    policy::CheckInOut detector{{two_crossings()}};
    policy::TimedHolds timed{policy::PolicyContext{two_crossings()}};
};

TEST_F(TimedHoldsTest, LeaveOtherPoliciesAloneWhereNoTimeIsSet) {
    ASSERT_EQ(leases_at(100.0).size(), 1U);
    EXPECT_STREQ(leases_at(100.0).front().policy, "check_in_out");
    timed.hold_from({core::VehicleKey{7}, signal}, core::Seconds(0.0));
    EXPECT_STREQ(leases_at(100.0).front().policy, "check_in_out") << "of another vehicle";
}

TEST_F(TimedHoldsTest, TakeTheirPlaceFromThatTimeOn) {
    timed.hold_from({vehicle, signal}, core::Seconds(102.0));
    EXPECT_TRUE(leases_at(101.5).empty());
    const auto leases = leases_at(102.0);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_STREQ(leases[0].policy, "timed_holds");
    EXPECT_EQ(std::get<core::SignalIndex>(leases[0].target), signal);
    EXPECT_EQ(leases[0].beneficiary, vehicle);
    EXPECT_FALSE(std::get<traffic::HoldGreen>(leases[0].action).own_links.empty());
    for (traffic::BelievedVehicle* const known :
         {&scene.belief().vehicles.front(), &scene.belief().own_states.front()}) {
        known->state.lane = two_crossings().lane_of(two_crossings().find_edge("A_B").value(), 1);
        known->state.lane_position_m = 5.0F;
        known->state.route_edge = 1;
    }
    EXPECT_TRUE(leases_at(110.0).empty()) << "it has passed";
}

TEST_F(TimedHoldsTest, AreAskedForAtDecisionsAlone) {
    timed.hold_from({vehicle, signal}, core::Seconds(0.0));
    EXPECT_TRUE(timed.in_place_of(leases_at(100.0), scene.belief(), false).empty());
}

TEST_F(TimedHoldsTest, FromATimeThatNeverComesAreNone) {
    timed.hold_from({vehicle, signal}, core::Seconds(std::numeric_limits<double>::infinity()));
    EXPECT_TRUE(leases_at(1e6).empty());
}

}  // namespace
}  // namespace clearway::testing
