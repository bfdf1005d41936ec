#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

SceneVehicle automated(const std::string& id, double position_m = 100.0, double speed_mps = 10.0) {
    return {id, VehicleClass::automated, {"west_A", "A_B", "B_east"}, 0, position_m, speed_mps};
}

traffic::DriveAt drive_at(double speed_mps) {
    return {core::MetresPerSecond(speed_mps)};
}

class VehicleLeases : public ::testing::TestWithParam<double> {};

TEST_P(VehicleLeases, set_a_speed_once_and_release_it_once_at_expiry) {
    ActuationBench bench(GetParam());
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(7.0), 3.0);
    const auto commands = bench.run_until(6.0);
    ASSERT_EQ(bench.only<traffic::SetSpeed>(commands).size(), 1U);
    EXPECT_DOUBLE_EQ(bench.only<traffic::SetSpeed>(commands)[0].speed.value, 7.0);
    EXPECT_EQ(bench.only<traffic::ReleaseSpeed>(commands).size(), 1U);
    EXPECT_EQ(commands.size(), 2U);
    EXPECT_EQ(bench.actuator.active(), 0U);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).expired, 1U);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).acted, 1U) << "once, however many steps it lasts";
}

TEST_P(VehicleLeases, renewed_in_time_are_not_released) {
    ActuationBench bench(GetParam());
    const auto vehicle = bench.add(automated("a"));
    for (int second = 0; second < 5; ++second) {
        bench.offer(vehicle, drive_at(7.0), 2.0);
        const auto commands = bench.run_until(second + 1.0);
        EXPECT_EQ(commands.size(), second == 0 ? 1U : 0U);
    }
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).issued, 1U);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).renewed, 4U);
}

INSTANTIATE_TEST_SUITE_P(Steps, VehicleLeases, ::testing::Values(0.1, 0.25, 1.0));

TEST(VehicleLease, that_could_never_be_carried_out_is_refused_with_its_reason) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(std::numeric_limits<double>::quiet_NaN()));
    bench.offer(vehicle, drive_at(std::numeric_limits<double>::infinity()));
    bench.offer(vehicle, drive_at(-1.0));
    bench.offer(vehicle, drive_at(5.0), 0.0);
    bench.offer(vehicle, traffic::HoldGreen{{0}});
    EXPECT_TRUE(bench.step().empty());
    const auto& refused = bench.counts(LeaseKind::drive_at).refused;
    EXPECT_EQ(refused.at(Refusal::speed_not_finite), 2U);
    EXPECT_EQ(refused.at(Refusal::speed_negative), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).acted, 0U);
    EXPECT_EQ(refused.at(Refusal::expired_on_arrival), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::hold_green).refused.at(Refusal::wrong_target), 1U);
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST(VehicleLease, for_a_vehicle_that_commands_do_not_reach_is_refused_and_the_running_one_expires) {
    ActuationBench bench;
    const auto near = bench.add(automated("a"));
    const auto far = bench.add(automated("b"));
    bench.offer(near, drive_at(7.0), 2.0);
    bench.offer(far, drive_at(7.0), 2.0);
    EXPECT_EQ(bench.only<traffic::SetSpeed>(bench.run_until(1.0)).size(), 2U);
    const auto renewal_of = [&](core::VehicleKey vehicle) {
        return traffic::Lease{vehicle, drive_at(7.0), bench.now + core::Seconds(2.0), 0, "policy", "a test",
                              {}};
    };
    bench.actuator.accept(std::vector{renewal_of(near), renewal_of(far)}, bench.now, std::vector{far});
    const auto commands = bench.run_until(2.75);
    ASSERT_EQ(commands.size(), 1U);
    EXPECT_EQ(bench.only<traffic::ReleaseSpeed>(commands)[0].vehicle, far);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).refused.at(Refusal::unreachable), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).renewed, 1U);
}

TEST(VehicleLease, above_what_the_vehicle_may_drive_is_refused_and_never_reaches_it) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(16.7));
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).refused.at(Refusal::above_allowed_speed), 1U);
}

TEST(VehicleLease, is_released_when_the_limit_falls_below_it) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(16.0), 10.0);
    EXPECT_EQ(bench.only<traffic::SetSpeed>(bench.step()).size(), 1U);
    bench.self.allowed_mps = 8.0;
    EXPECT_EQ(bench.only<traffic::ReleaseSpeed>(bench.step()).size(), 1U);
    EXPECT_TRUE(bench.step().empty());
}

TEST(VehicleLease, for_a_human_driver_is_refused) {
    ActuationBench bench;
    const auto vehicle = bench.add({"h", VehicleClass::human, {"west_A", "A_B"}, 0, 100.0, 10.0});
    bench.offer(vehicle, drive_at(5.0));
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).refused.at(Refusal::not_controllable), 1U);
}

TEST(VehicleLease, of_higher_priority_wins_and_the_other_follows_when_it_ends) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(5.0), 4.0, 0, "low");
    bench.offer(vehicle, drive_at(9.0), 2.0, 1, "high");
    const auto speeds = bench.only<traffic::SetSpeed>(bench.run_until(3.0));
    ASSERT_EQ(speeds.size(), 2U);
    EXPECT_DOUBLE_EQ(speeds[0].speed.value, 9.0);
    EXPECT_DOUBLE_EQ(speeds[1].speed.value, 5.0);
    EXPECT_EQ(bench.counts(LeaseKind::drive_at, "low").refused.at(Refusal::outranked), 1U);
}

TEST(VehicleLease, of_equal_priority_yields_to_the_earlier) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(5.0), 4.0, 0, "first");
    bench.offer(vehicle, drive_at(9.0), 4.0, 0, "second");
    EXPECT_DOUBLE_EQ(bench.only<traffic::SetSpeed>(bench.step()).at(0).speed.value, 5.0);
}

TEST(VehicleLease, of_a_vehicle_that_left_is_dropped_and_what_it_set_is_given_back_if_it_returns) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(5.0), 60.0);
    bench.step();
    const auto state = bench.on_road.at(vehicle);
    bench.on_road.erase(vehicle);
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::drive_at).refused.at(Refusal::vehicle_gone), 1U);
    EXPECT_EQ(bench.actuator.active(), 0U);
    bench.on_road[vehicle] = state;
    EXPECT_EQ(bench.only<traffic::ReleaseSpeed>(bench.step()).size(), 1U);
    EXPECT_TRUE(bench.run_until(5.0).empty());
}

TEST(LaneLease, of_an_emergency_vehicle_for_itself_is_counted_apart) {
    ActuationBench bench;
    const auto one = bench.add(automated("a"));
    const auto other = bench.add(automated("b"));
    bench.offer(one, traffic::ChangeLane{1}, 4.0, 0, "policy", one);
    bench.offer(other, traffic::ChangeLane{1}, 4.0, 0, "policy", one);
    bench.offer(other, traffic::ChangeLane{1}, 4.0, 0, "policy", one);
    EXPECT_EQ(bench.counts(LeaseKind::own_change_lane).issued, 1U);
    EXPECT_EQ(bench.counts(LeaseKind::own_change_lane).renewed, 0U);
    EXPECT_EQ(bench.counts(LeaseKind::change_lane).issued, 1U);
    EXPECT_EQ(bench.counts(LeaseKind::change_lane).renewed, 1U);
}

TEST(LaneLease, requests_the_lane_only_when_there_is_room_and_tries_again) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.self.room_beside = false;
    bench.offer(vehicle, traffic::ChangeLane{1}, 4.0);
    EXPECT_TRUE(bench.run_until(1.0).empty());
    EXPECT_EQ(bench.counts(LeaseKind::change_lane).refused.at(Refusal::no_room_beside), 1U);
    bench.self.room_beside = true;
    const auto requests = bench.only<traffic::RequestLane>(bench.step());
    ASSERT_EQ(requests.size(), 1U);
    EXPECT_EQ(requests[0].lane_number, 1U);
    EXPECT_GT(requests[0].duration.value, 0.0);
}

TEST(LaneLease, into_a_lane_that_does_not_continue_is_refused_unless_it_is_long) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.self.outlook[1] = {1, 300.0F, -1};
    bench.offer(vehicle, traffic::ChangeLane{1}, 4.0);
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::change_lane).refused.at(Refusal::lane_does_not_continue), 1U);
    bench.self.outlook[1].drivable_m = 301.0F;
    EXPECT_EQ(bench.only<traffic::RequestLane>(bench.step()).size(), 1U);
}

TEST(LaneLease, to_a_lane_that_does_not_exist_is_refused) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::ChangeLane{2}, 4.0);
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::change_lane).refused.at(Refusal::no_such_lane), 1U);
}

TEST(LaneLease, ends_with_the_edge_it_was_meant_for) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::ChangeLane{1}, 10.0);
    bench.step();
    bench.on_road[vehicle].lane = two_crossings().lane_of(two_crossings().find_edge("A_B").value(), 0);
    EXPECT_EQ(bench.only<traffic::ReleaseLane>(bench.step()).size(), 1U);
    EXPECT_EQ(bench.actuator.active(), 0U);
    EXPECT_TRUE(bench.run_until(3.0).empty());
}

TEST(LaneLease, keeps_the_vehicle_on_its_lane_until_it_ends_and_needs_no_release_then) {
    ActuationBench bench(1.0);
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::ChangeLane{0}, 8.0);
    double kept_until = 0.0;
    for (int second = 1; second <= 8; ++second) {
        for (const auto& request : bench.only<traffic::RequestLane>(bench.step())) {
            EXPECT_LE(request.duration.value, 3.0);
            kept_until = bench.now.value + request.duration.value;
        }
        EXPECT_GE(kept_until, std::min(8.0, second + 1.0));
        EXPECT_LE(kept_until, 8.0);
    }
    EXPECT_TRUE(bench.run_until(12.0).empty());
}

TEST(HoldLaneLease, restores_the_freedom_to_change_once) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::HoldLane{}, 1.0);
    const auto freedoms = bench.only<traffic::SetLaneChangeFreedom>(bench.run_until(3.0));
    ASSERT_EQ(freedoms.size(), 2U);
    EXPECT_EQ(freedoms[0].freedom, traffic::LaneChangeFreedom::strategic_only);
    EXPECT_EQ(freedoms[1].freedom, traffic::LaneChangeFreedom::normal);
}

TEST(StandBackLease, is_counted_and_does_nothing) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a", 300.0, 10.0));
    bench.offer(vehicle, traffic::StandBack{});
    bench.offer(vehicle, traffic::StandBack{});
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::stand_back).refused.at(Refusal::stood_back), 2U);
    EXPECT_EQ(bench.counts(LeaseKind::stand_back).acted, 0U);
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST(StopAtLineLease, that_needs_hard_braking_is_refused) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a", 480.0, 16.0));
    bench.offer(vehicle, traffic::StopAtLine{});
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::stop_at_line).refused.at(Refusal::cannot_stop_comfortably), 1U);
}

TEST(StopAtLineLease, stops_the_vehicle_on_its_lane_before_the_line_until_it_ends) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a", 400.0, 16.0));
    bench.offer(vehicle, traffic::StopAtLine{}, 2.0);
    const auto stopping = bench.run_until(1.0);
    ASSERT_EQ(stopping.size(), 1U);
    const auto stops = bench.only<traffic::StopOnLane>(stopping);
    ASSERT_EQ(stops.size(), 1U);
    EXPECT_EQ(stops[0].place, traffic::StopPlace::on_lane);
    EXPECT_DOUBLE_EQ(stops[0].position.value,
                     two_crossings().lane(bench.on_road[vehicle].lane).length_m - 1.0);
    bench.offer(vehicle, traffic::StopAtLine{}, 2.0);
    EXPECT_TRUE(bench.run_until(2.5).empty()) << "renewed";
    EXPECT_EQ(bench.only<traffic::ResumeFromStop>(bench.run_until(6.0)).size(), 1U);
}

TEST(StopAtLineLease, on_a_lane_that_does_not_continue_is_refused) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a", 300.0, 10.0));
    bench.self.outlook[two_crossings().lane(bench.on_road[vehicle].lane).number] = {0, 200.0F, 1};
    bench.offer(vehicle, traffic::StopAtLine{});
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::stop_at_line).refused.at(Refusal::lane_does_not_continue), 1U);
}

TEST(StopAtLineLease, counts_the_way_until_the_command_acts) {
    ActuationBench bench(1.0);
    const double length_m = two_crossings().lane(two_crossings().find_lane("west_A_0").value()).length_m;
    const double braking_m = 16.0 * 16.0 / (2.0 * 4.5);
    const auto late = bench.add(automated("late", length_m - 1.0 - braking_m - 10.0, 16.0));
    const auto early = bench.add(automated("early", length_m - 1.0 - braking_m - 20.0, 16.0));
    bench.step();
    bench.offer(late, traffic::StopAtLine{});
    bench.offer(early, traffic::StopAtLine{});
    const auto stops = bench.only<traffic::StopOnLane>(bench.step());
    ASSERT_EQ(stops.size(), 1U);
    EXPECT_EQ(stops[0].vehicle, early) << "16 m pass before the other one brakes";
}

TEST(StopAtLineLease, of_a_vehicle_that_pulls_aside_waits_until_it_is_back) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a", 300.0, 16.0));
    bench.offer(vehicle, traffic::PullAside{}, 1.0);
    bench.offer(vehicle, traffic::StopAtLine{}, 4.0);
    const auto commands = bench.run_until(3.0);
    const auto stops = bench.only<traffic::StopOnLane>(commands);
    ASSERT_EQ(stops.size(), 2U);
    EXPECT_EQ(stops[0].place, traffic::StopPlace::beside_road);
    EXPECT_EQ(stops[1].place, traffic::StopPlace::on_lane);
    EXPECT_EQ(bench.only<traffic::ResumeFromStop>(commands).size(), 1U);
}

TEST(PassRedLease, is_for_emergency_vehicles_only) {
    ActuationBench bench;
    const auto helper = bench.add(automated("a"));
    const auto emergency = bench.add({"e", VehicleClass::emergency, {"west_A", "A_B"}, 1, 50.0, 10.0});
    bench.offer(helper, traffic::PassRed{}, 1.0);
    bench.offer(emergency, traffic::PassRed{}, 1.0);
    const auto set = bench.only<traffic::SetJunctionPrivilege>(bench.run_until(3.0));
    ASSERT_EQ(set.size(), 2U);
    EXPECT_EQ(set[0].vehicle, emergency);
    EXPECT_EQ(set[0].privilege, traffic::JunctionPrivilege::pass_red);
    EXPECT_EQ(set[1].privilege, traffic::JunctionPrivilege::none);
    EXPECT_EQ(bench.counts(LeaseKind::pass_red).refused.at(Refusal::not_an_emergency_vehicle), 1U);
}

TEST(PullAsideLease, keeps_to_an_edge_of_the_lane_in_the_sublane_model) {
    actuation::Actuator::Config config;
    config.lateral_model = traffic::LateralModel::sublane;
    ActuationBench bench(0.25, config);
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::PullAside{traffic::Side::left}, 1.0);
    const auto commands = bench.run_until(2.0);
    const auto set = bench.only<traffic::SetLateralAlignment>(commands);
    ASSERT_EQ(set.size(), 2U);
    EXPECT_EQ(set[0].alignment, traffic::LateralAlignment::left);
    EXPECT_EQ(set[1].alignment, traffic::LateralAlignment::usual);
    EXPECT_TRUE(bench.only<traffic::StopOnLane>(commands).empty());
}

TEST(PullAsideLease, stops_beside_the_road_without_the_sublane_model_and_returns_when_it_ends) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::PullAside{}, 5.0);
    const auto stopping = bench.run_until(2.0);
    ASSERT_EQ(bench.only<traffic::StopOnLane>(stopping).size(), 1U);
    EXPECT_EQ(bench.only<traffic::StopOnLane>(stopping)[0].place, traffic::StopPlace::beside_road);
    EXPECT_EQ(stopping.size(), 1U);
    bench.on_road.erase(vehicle);  // it stands beside the road now
    EXPECT_TRUE(bench.run_until(4.75).empty());
    EXPECT_EQ(bench.only<traffic::ResumeFromStop>(bench.run_until(8.0)).size(), 1U);
    EXPECT_EQ(bench.actuator.active(), 0U);
    EXPECT_EQ(bench.counts(LeaseKind::pull_aside).acted, 1U);
    EXPECT_EQ(bench.counts(LeaseKind::pull_aside).expired, 1U);
    EXPECT_TRUE(bench.counts(LeaseKind::pull_aside).refused.empty());
}

TEST(PullAsideLease, that_is_renewed_keeps_the_vehicle_beside_the_road) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::PullAside{}, 2.0);
    bench.run_until(1.0);
    bench.on_road.erase(vehicle);
    for (const double second : {2.0, 3.0, 4.0}) {
        bench.offer(vehicle, traffic::PullAside{}, 2.0);
        EXPECT_TRUE(bench.run_until(second).empty());
    }
    EXPECT_EQ(bench.only<traffic::ResumeFromStop>(bench.run_until(6.0)).size(), 1U);
}

TEST(PullAsideLease, of_a_vehicle_beside_the_road_is_given_back_by_restore_all) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, traffic::PullAside{}, 60.0);
    bench.step();
    bench.on_road.erase(vehicle);
    bench.step();
    std::vector<traffic::Command> commands;
    bench.actuator.restore_all(commands);
    ASSERT_EQ(commands.size(), 1U);
    EXPECT_EQ(bench.only<traffic::ResumeFromStop>(commands)[0].vehicle, vehicle);
}

TEST(PullAsideLease, is_refused_on_a_junction_and_where_the_lane_is_too_short_to_stop) {
    ActuationBench bench;
    const auto late = bench.add(automated("late", 480.0, 16.0));
    const auto crossing = bench.add(automated("crossing"));
    bench.on_road.at(crossing).lane = two_crossings().find_lane(":A_13_0").value();
    bench.offer(late, traffic::PullAside{});
    bench.offer(crossing, traffic::PullAside{});
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::pull_aside).refused.at(Refusal::cannot_stop_comfortably), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::pull_aside).refused.at(Refusal::on_a_junction), 1U);
}

TEST(SafetyChecks, switched_off_are_off_for_controlled_vehicles_and_come_back_with_the_last_lease) {
    actuation::Actuator::Config config;
    config.safety_checks = traffic::SafetyChecks::off;
    ActuationBench bench(0.25, config);
    const auto vehicle = bench.add(automated("a"));
    bench.self.room_beside = false;
    bench.offer(vehicle, traffic::ChangeLane{1}, 1.0);
    const auto commands = bench.run_until(3.0);
    EXPECT_EQ(bench.only<traffic::RequestLane>(commands).size(), 1U);
    const auto checks = bench.only<traffic::SetSafetyChecks>(commands);
    ASSERT_EQ(checks.size(), 2U);
    EXPECT_EQ(checks[0].checks, traffic::SafetyChecks::off);
    EXPECT_EQ(checks[1].checks, traffic::SafetyChecks::on);
}

TEST(RestoreAll, gives_back_everything_held) {
    ActuationBench bench;
    const auto vehicle = bench.add(automated("a"));
    bench.offer(vehicle, drive_at(5.0), 60.0);
    bench.offer(vehicle, traffic::ChangeLane{1}, 60.0);
    bench.offer(core::SignalIndex{0}, traffic::HoldGreen{{1}}, 60.0);
    bench.step();
    std::vector<traffic::Command> commands;
    bench.actuator.restore_all(commands);
    EXPECT_EQ(bench.only<traffic::ReleaseSpeed>(commands).size(), 1U);
    EXPECT_EQ(bench.only<traffic::ReleaseLane>(commands).size(), 1U);
    EXPECT_EQ(bench.only<traffic::RestoreProgram>(commands).size(), 1U);
    EXPECT_EQ(commands.size(), 3U);
    EXPECT_EQ(bench.actuator.active(), 0U);
    commands.clear();
    bench.actuator.restore_all(commands);
    EXPECT_TRUE(commands.empty());
}

}  // namespace
}  // namespace clearway::testing
