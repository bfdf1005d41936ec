// Leases that send an emergency vehicle another way.

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

const std::vector<std::string> over_b0 = {"left0A0", "A0B0", "B0B1", "B1right1"};

std::vector<core::EdgeIndex> edges(const std::vector<std::string>& ids) {
    std::vector<core::EdgeIndex> found;
    for (const std::string& id : ids)
        found.push_back(short_square().find_edge(id).value());
    return found;
}

class WayLease : public ::testing::Test {
  protected:
    core::VehicleKey add(VehicleClass kind = VehicleClass::emergency, double position_m = 50.0) {
        return bench.add({"e", kind, over_b0, 0, position_m, 10.0});
    }
    std::vector<traffic::SetRoute> ask(core::VehicleKey vehicle, const std::vector<core::EdgeIndex>& way) {
        bench.offer(vehicle, traffic::TakeRoute{way}, 2.0, 0, "policy", vehicle);
        return bench.only<traffic::SetRoute>(bench.step());
    }
    void know(const std::vector<std::string>& ids, bool closed_to_emergency) {
        std::vector<traffic::KnownIncident> known;
        for (const core::EdgeIndex edge : edges(ids))
            known.push_back({.edge = edge, .closed_to_emergency = closed_to_emergency});
        bench.actuator.know(known);
    }
    std::uint64_t refused(Refusal reason) const {
        const auto& refused = bench.counts(LeaseKind::take_route).refused;
        return refused.contains(reason) ? refused.at(reason) : 0;
    }

    ActuationBench bench{0.25, fixed_clearance(), short_square()};
    std::vector<core::EdgeIndex> over_a1 = edges({"left0A0", "A0A1", "A1B1", "B1right1"});
};

TEST_F(WayLease, is_commanded_and_has_acted_once_the_vehicle_drives_it) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    const auto commands = ask(vehicle, over_a1);
    ASSERT_EQ(commands.size(), 1U);
    EXPECT_EQ(commands[0].edges, over_a1);
    bench.scene.roster().set_route(vehicle, bench.scene.roster().add_route(over_a1));
    EXPECT_TRUE(bench.run_until(1.5).empty()) << "it drives there already";
    EXPECT_EQ(bench.counts(LeaseKind::take_route).acted, 1U);
    EXPECT_TRUE(bench.run_until(5.0).empty()) << "and stays on it";
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST_F(WayLease, that_is_only_considered_is_counted_and_leaves_the_vehicle_s_other_leases_alone) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    bench.offer(vehicle, traffic::PassRed{}, 2.0, 0, "policy", vehicle);
    EXPECT_EQ(bench.only<traffic::SetJunctionPrivilege>(bench.step()).size(), 1U);
    bench.offer(vehicle, traffic::StandBack{over_a1}, 2.0, 0, "policy", vehicle);
    EXPECT_TRUE(bench.step().empty());
    EXPECT_EQ(bench.counts(LeaseKind::consider_way).refused.at(Refusal::stood_back), 1U);
    EXPECT_EQ(bench.counts(LeaseKind::consider_way).acted, 0U);
    EXPECT_EQ(bench.actuator.active(), 1U);
}

TEST_F(WayLease, what_was_driven_of_it_is_left_out) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle =
        bench.add({"e", VehicleClass::emergency, {"A0A1", "A1A0", "A0B0", "B0B1", "B1right1"}, 0, 5.0, 1.0});
    const auto commands = ask(vehicle, over_a1);
    ASSERT_EQ(commands.size(), 1U);
    EXPECT_EQ(commands[0].edges, edges({"A0A1", "A1B1", "B1right1"}));
}

TEST_F(WayLease, that_can_never_be_driven_is_refused) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    EXPECT_TRUE(ask(vehicle, {}).empty());
    EXPECT_TRUE(ask(vehicle, {core::EdgeIndex{99999}}).empty());
    EXPECT_EQ(refused(Refusal::no_such_edge), 2U);
    EXPECT_TRUE(ask(vehicle, edges({"left0A0", "A1B1", "B1right1"})).empty());
    EXPECT_EQ(refused(Refusal::route_gap), 1U);
    EXPECT_EQ(bench.actuator.active(), 0U);
}

TEST_F(WayLease, from_elsewhere_or_to_elsewhere_is_refused) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    EXPECT_TRUE(ask(vehicle, edges({"A0A1", "A1B1", "B1right1"})).empty());
    EXPECT_EQ(refused(Refusal::route_elsewhere), 1U);
    bench.run_until(5.0);
    EXPECT_TRUE(ask(vehicle, edges({"left0A0", "A0A1", "A1B1"})).empty());
    EXPECT_EQ(refused(Refusal::route_elsewhere), 2U);
}

TEST_F(WayLease, of_a_vehicle_that_passes_its_destination_before_it_ends_there_is_refused) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle =
        bench.add({"e", VehicleClass::emergency, {"A0B0", "B0B1", "B1A1", "A1A0", "A0B0"}, 0, 5.0, 1.0});
    EXPECT_TRUE(ask(vehicle, edges({"A0B0"})).empty());
    EXPECT_EQ(refused(Refusal::route_elsewhere), 1U);
}

TEST_F(WayLease, is_for_emergency_vehicles) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add(VehicleClass::automated);
    EXPECT_TRUE(ask(vehicle, over_a1).empty());
    EXPECT_EQ(refused(Refusal::not_an_emergency_vehicle), 1U);
}

TEST_F(WayLease, with_a_turn_too_near_to_stop_before_is_refused_until_there_is_room) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add(VehicleClass::emergency, 185.0);  // 7.8 m left, 11 m to stop
    EXPECT_TRUE(ask(vehicle, over_a1).empty());
    EXPECT_EQ(refused(Refusal::past_decision), 1U);
    bench.on_road.at(vehicle).speed_mps = 0.0F;
    EXPECT_EQ(bench.only<traffic::SetRoute>(bench.step()).size(), 1U) << "it stands at the line";
}

TEST_F(WayLease, over_a_road_known_to_be_closed_is_refused_until_it_is_open) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    know({"A0A1"}, true);
    EXPECT_TRUE(ask(vehicle, over_a1).empty());
    EXPECT_EQ(refused(Refusal::closed), 1U);
    bench.actuator.know({});
    EXPECT_EQ(bench.only<traffic::SetRoute>(bench.step()).size(), 1U);
}

TEST_F(WayLease, over_a_road_that_an_incident_leaves_open_to_emergency_vehicles_is_not_refused) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    know({"A0A1"}, false);
    EXPECT_EQ(ask(vehicle, over_a1).size(), 1U);
}

TEST_F(WayLease, from_a_closed_road_or_to_it_is_not_refused) {
    bench.scene = CrossingScene(100.0, short_square());
    const core::VehicleKey vehicle = add();
    know({"left0A0", "B1right1"}, true);
    EXPECT_EQ(ask(vehicle, over_a1).size(), 1U);
}

}  // namespace
}  // namespace clearway::testing
