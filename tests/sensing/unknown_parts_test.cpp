// What a receiver does not know for certain: lanes, routes, signals.
#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>

#include "sensing/processes.hpp"
#include "sensing/sensor.hpp"
#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {

using namespace failures;

namespace {

using testing::Crowd;
using testing::draws;
using testing::find;
using testing::small_scene;

traffic::Observation observe(const support::Scene& scene, const truth::Snapshot& snapshot,
                             const std::string& failure) {
    const auto sensor = make_sensor(failure_from(failure), draws(), {scene.network(), {}});
    traffic::Observation observation;
    sensor->observe(snapshot, scene.roster(), observation);
    return observation;
}

TEST(MapMatching, KnowsNothingOfTheTruePlaceButItsPositionAndHeading) {
    const support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..h..a...+..h..h
        ..h......+......
    )");
    truth::Snapshot elsewhere = scene.snapshot();
    for (core::VehicleIndex row = 0; row < elsewhere.size(); ++row) {
        elsewhere.lane[row] = scene.network().lane_of(*scene.network().find_edge("road_0"), 0);
        elsewhere.lane_position_m[row] = 1.0F;
        elsewhere.route_edge[row] = 0;
    }
    for (const char* const failure : {"D3M", "D3M,route_share=0"}) {
        const traffic::Observation right = observe(scene, scene.snapshot(), failure);
        const traffic::Observation wrong = observe(scene, elsewhere, failure);
        ASSERT_EQ(right.vehicles.size(), scene.snapshot().size());
        for (const traffic::ObservedVehicle& vehicle : right.vehicles) {
            const traffic::MotionState& other = find(wrong, vehicle.key)->state;
            EXPECT_EQ(vehicle.state.lane, other.lane);
            EXPECT_EQ(vehicle.state.lane_position_m, other.lane_position_m);
            EXPECT_EQ(vehicle.state.route_edge, other.route_edge);
        }
    }
    // Without any error, the nearest place is the true one.
    const traffic::Observation exact = observe(scene, elsewhere, "map_matching=nearest");
    for (const traffic::ObservedVehicle& vehicle : exact.vehicles) {
        const core::VehicleIndex row = scene.row(scene.id(vehicle.key));
        EXPECT_EQ(vehicle.state.lane, scene.snapshot().lane[row]);
        EXPECT_NEAR(vehicle.state.lane_position_m, scene.snapshot().lane_position_m[row], 1e-3);
        EXPECT_EQ(vehicle.state.route_edge, scene.snapshot().route_edge[row]);
    }
}

TEST(MapMatching, LeavesThePositionsOfTheErrorAlone) {
    const traffic::Observation exact = observe(small_scene(), small_scene().snapshot(), "D3");
    const traffic::Observation matched = observe(small_scene(), small_scene().snapshot(), "D3M");
    for (const traffic::ObservedVehicle& vehicle : exact.vehicles) {
        EXPECT_EQ(vehicle.state.x_m, find(matched, vehicle.key)->state.x_m);
        EXPECT_EQ(vehicle.state.y_m, find(matched, vehicle.key)->state.y_m);
    }
}

TEST(MapMatching, SaysThereIsNoLaneWhereNoneIsNear) {
    truth::Snapshot away = small_scene().snapshot();
    const core::VehicleIndex row = small_scene().row("a1");
    away.y_m[row] += 500.0F;
    const traffic::Observation seen = observe(small_scene(), away, "D3M");
    EXPECT_FALSE(find(seen, small_scene().key("a1"))->state.lane.exists());
    EXPECT_TRUE(find(seen, small_scene().key("h1"))->state.lane.exists());
}

TEST(HeadingNoise, HasTheStatedDeviationAndStaysWithinATurn) {
    FailureConfig config;
    config.heading_sigma_deg = 10.0;
    const NoiseProcess noise(config, draws(), small_scene().network());
    EXPECT_FALSE(noise.none());
    double square = 0.0;
    constexpr int count = 20000;
    for (int report = 0; report < count; ++report) {
        traffic::MotionState state;
        state.heading_rad = 3.1F;
        noise.apply(core::vehicle_key("one"), static_cast<ReportNumber>(report), state);
        EXPECT_LE(std::abs(state.heading_rad), std::numbers::pi + 1e-6);
        square += std::pow(std::remainder(state.heading_rad - 3.1, 2.0 * std::numbers::pi), 2);
    }
    EXPECT_NEAR(std::sqrt(square / count) * 180.0 / std::numbers::pi, 10.0, 0.15);  // Standard error 0.05.
}

TEST(RouteProcess, HasTheShareAndALargerOneHasTheSameVehiclesAndMore) {
    const auto share = [](double value) {
        FailureConfig config;
        config.route_share = value;
        return RouteProcess(config, draws());
    };
    const RouteProcess half = share(0.5), most = share(0.8), all = share(1.0), none = share(0.0);
    int known = 0;
    for (int number = 0; number < 10000; ++number) {
        const core::VehicleKey key = core::vehicle_key("vehicle" + std::to_string(number));
        const auto human = traffic::VehicleClass::human;
        known += half.known(key, human) ? 1 : 0;
        EXPECT_TRUE(!half.known(key, human) || most.known(key, human));
        EXPECT_TRUE(all.known(key, human));
        EXPECT_FALSE(none.known(key, traffic::VehicleClass::automated));
        EXPECT_TRUE(none.known(key, traffic::VehicleClass::emergency));
    }
    EXPECT_NEAR(known / 10000.0, 0.5, 0.015);  // Standard error 0.005.
}

TEST(RouteShare, HidesRouteAndPlaceInItButNothingElse) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..h..a...+..h..a
        ..e......+......
    )");
    // The sensors own the rosters.
    const auto knowing = make_sensor(failure_from("report_interval_s=1"), draws(), {scene.network(), {}});
    const auto ignorant = make_sensor(failure_from("R0"), draws(), {scene.network(), {}});
    traffic::Observation all;
    traffic::Observation none;
    knowing->observe(scene.snapshot(), scene.roster(), all);
    ignorant->observe(scene.snapshot(), scene.roster(), none);
    ASSERT_EQ(none.vehicles.size(), all.vehicles.size());
    for (const traffic::ObservedVehicle& vehicle : none.vehicles) {
        const bool emergency = vehicle.vehicle_class == traffic::VehicleClass::emergency;
        EXPECT_EQ(none.roster->find(vehicle.key)->route.exists(), emergency);
        const traffic::MotionState& known = find(all, vehicle.key)->state;
        EXPECT_EQ(vehicle.state.route_edge, emergency ? known.route_edge : 0U);
        EXPECT_EQ(vehicle.state.lane, known.lane);
        EXPECT_EQ(vehicle.state.x_m, known.x_m);
        EXPECT_EQ(none.roster->find(vehicle.key)->length_m, all.roster->find(vehicle.key)->length_m);
    }
    EXPECT_EQ(find(all, scene.key("h2"))->state.route_edge, 1U);
}

TEST(RouteShare, DrawsTheSameVehiclesWhoeverElseIsThereAndWheneverItStarts) {
    const auto known = [](Crowd crowd, double start_s) {
        FailureConfig config;
        config.route_share = 0.5;
        const auto sensor = make_sensor(config, draws(), {small_scene().network(), {}});
        const core::RouteIndex route = crowd.roster.add_route({core::EdgeIndex{0}});
        for (const core::VehicleKey key : crowd.snapshot.key)
            crowd.roster.set_route(key, route);
        crowd.at(start_s);
        traffic::Observation observation;
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        std::set<core::VehicleKey> keys;
        for (const traffic::VehicleInfo& info : observation.roster->vehicles()) {
            if (info.route.exists()) keys.insert(info.key);
        }
        return keys;
    };
    const auto all = known(Crowd(200), 0.0);
    const auto few = known(Crowd(50, 100), 30.0);
    for (const core::VehicleKey key : Crowd(50, 100).snapshot.key)
        EXPECT_EQ(few.contains(key), all.contains(key));
    EXPECT_GT(few.size(), 10u);
    EXPECT_LT(few.size(), 45u);
}

TEST(SignalsKnown, HidesTheLettersOfEverySignal) {
    const support::Scene scene(R"(
        10 m per cell
        ..h.a..|G....|r...
    )");
    const traffic::Observation known = observe(scene, scene.snapshot(), "report_interval_s=1");
    const traffic::Observation hidden = observe(scene, scene.snapshot(), "S0");
    EXPECT_EQ(known.signals.state, scene.snapshot().signals.state);
    EXPECT_THAT(hidden.signals.state, ::testing::ElementsAre("", ""));
    EXPECT_EQ(hidden.vehicles.size(), known.vehicles.size());
}

}  // namespace
}  // namespace clearway::sensing
