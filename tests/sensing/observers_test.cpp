// Who is seen by others: roadside units, on-board sensors, and what stands in between.
#include "sensing/observers.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "sensing/line_of_sight.hpp"
#include "sensing/processes.hpp"
#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {

using namespace failures;

namespace {

using testing::draws;
using testing::find;

TEST(LineOfSight, IsBlockedByABoxBetweenAndByNoneBeside) {
    const Box car{{10.0F, 0.0F}, 0.0F, 2.5F, 0.9F};
    EXPECT_TRUE(blocks(car, {0.0F, 0.0F}, {20.0F, 0.0F}));
    EXPECT_TRUE(blocks(car, {20.0F, 0.5F}, {0.0F, 0.5F})) << "the same from the other side";
    EXPECT_FALSE(blocks(car, {0.0F, 1.0F}, {20.0F, 1.0F})) << "beside it";
    EXPECT_FALSE(blocks(car, {0.0F, 0.0F}, {7.0F, 0.0F})) << "it stands behind the target";
    EXPECT_FALSE(blocks(car, {13.0F, 0.0F}, {20.0F, 0.0F})) << "it stands behind the observer";
    EXPECT_TRUE(blocks(car, {10.0F, -5.0F}, {10.0F, 5.0F})) << "across";
    EXPECT_FALSE(blocks(car, {13.0F, -5.0F}, {13.0F, 5.0F}));
    EXPECT_TRUE(blocks(car, {7.0F, -2.0F}, {13.0F, 2.0F})) << "diagonally through the middle";
    EXPECT_FALSE(blocks(car, {5.0F, -1.0F}, {9.0F, 3.0F})) << "past a corner";
}

TEST(LineOfSight, TurnsWithTheBox) {
    const Box lengthwise{{10.0F, 0.0F}, 0.0F, 2.5F, 0.9F};
    const Box across{{10.0F, 0.0F}, std::numbers::pi_v<float> / 2.0F, 2.5F, 0.9F};
    EXPECT_FALSE(blocks(lengthwise, {0.0F, 2.0F}, {20.0F, 2.0F}));
    EXPECT_TRUE(blocks(across, {0.0F, 2.0F}, {20.0F, 2.0F}));
}

TEST(LineOfSight, TakesTheBoxFromTheFrontBumper) {
    const Box box = box_from({10.0F, 3.0F}, 0.0F, 5.0F, 1.8F);
    EXPECT_FLOAT_EQ(box.centre.x_m, 7.5F);
    EXPECT_FLOAT_EQ(box.centre.y_m, 3.0F);
    EXPECT_FLOAT_EQ(box.half_length_m, 2.5F);
    EXPECT_FLOAT_EQ(box.half_width_m, 0.9F);
}

traffic::Observation observe(const support::Scene& scene, const FailureConfig& config) {
    const auto sensor = make_sensor(config, draws(), {scene.network(), {}});
    traffic::Observation observation;
    sensor->observe(scene.snapshot(), scene.roster(), observation);
    // The roster belongs to the sensor.
    observation.roster = nullptr;
    return observation;
}

/// Nobody human reports.
FailureConfig unequipped() {
    FailureConfig config;
    config.connected_share = 0.0;
    return config;
}

TEST(OnBoardSensors, SeeTheUnequippedWithinTheirRange) {
    const support::Scene scene(R"(
        10 m per cell
        h..h.a.......h....h
    )");
    FailureConfig config = unequipped();
    config.onboard_range_m = 60.0;
    const traffic::Observation seen = observe(scene, config);
    EXPECT_NE(find(seen, scene.key("h1")), nullptr) << "50 m";
    EXPECT_NE(find(seen, scene.key("h2")), nullptr) << "20 m";
    EXPECT_EQ(find(seen, scene.key("h3")), nullptr) << "80 m";
    EXPECT_EQ(find(seen, scene.key("a1"))->position_sigma_m, 0.0F) << "it reports itself";
    EXPECT_EQ(find(seen, scene.key("h2"))->position_sigma_m, 0.5F);
    EXPECT_EQ(find(seen, scene.key("h2"))->freshness, traffic::Freshness::fresh);
    EXPECT_TRUE(observe(scene, unequipped()).vehicles.size() == 1u) << "only a1 without them";
}

TEST(OnBoardSensors, SeeNobodyBehindAnotherVehicleWhenOcclusionCounts) {
    const support::Scene scene(R"(
        10 m per cell
        h......h...
        h..h.a.....
    )");
    FailureConfig config = unequipped();
    config.onboard_range_m = 80.0;
    EXPECT_EQ(observe(scene, config).vehicles.size(), 5u);
    config.occlusion = Occlusion::considered;
    const traffic::Observation seen = observe(scene, config);
    EXPECT_NE(find(seen, scene.key("h4")), nullptr) << "the next in the lane";
    EXPECT_EQ(find(seen, scene.key("h3")), nullptr) << "behind h4";
    EXPECT_NE(find(seen, scene.key("h1")), nullptr) << "in the other lane, past h4";
    EXPECT_NE(find(seen, scene.key("h2")), nullptr);
}

TEST(OnBoardSensors, AreOfNoUseWhileTheirVehicleIsDark) {
    const support::Scene scene(R"(
        10 m per cell
        ..h.a.....
    )");
    FailureConfig config = unequipped();
    config.onboard_range_m = 60.0;
    config.loss_rate = 1.0;
    EXPECT_TRUE(observe(scene, config).vehicles.empty());
}

TEST(RoadsideUnits, SeeWhoeverIsNearTheStopLines) {
    // The stop lines are 60 m into the drawing; the unit stands between them and that of the crossing street.
    const support::Scene scene(R"(
        10 m per cell
        h...h.|G...h...........h
        h.....|r................
    )");
    FailureConfig config = unequipped();
    config.roadside_range_m = 45.0;
    config.roadside_sigma_m = 2.0;
    const traffic::Observation seen = observe(scene, config);
    EXPECT_NE(find(seen, scene.key("h2")), nullptr) << "15 m before its line";
    EXPECT_EQ(find(seen, scene.key("h2"))->position_sigma_m, 2.0F);
    EXPECT_EQ(find(seen, scene.key("h4")), nullptr) << "about 180 m on";
    FailureConfig farther = config;
    farther.roadside_range_m = 1000.0;
    EXPECT_EQ(observe(scene, farther).vehicles.size(), 5u);
}

TEST(RoadsideUnits, GiveTheBetterOfTwoPositions) {
    const support::Scene scene(R"(
        10 m per cell
        ..h.a.|G....
    )");
    FailureConfig config = unequipped();
    config.roadside_range_m = 1000.0;
    config.onboard_range_m = 60.0;
    EXPECT_EQ(find(observe(scene, config), scene.key("h1"))->position_sigma_m, 0.5F);
    config.roadside_sigma_m = 0.25;
    EXPECT_EQ(find(observe(scene, config), scene.key("h1"))->position_sigma_m, 0.25F);
}

TEST(SeenVehicles, HaveAPositionOfTheStatedErrorAndNoRoute) {
    const support::Scene scene(R"(
        10 m per cell
        ..h.a.....
    )");
    FailureConfig config = unequipped();
    config.onboard_range_m = 60.0;
    config.onboard_sigma_m = 2.0;
    const auto sensor = make_sensor(config, draws(), {scene.network(), {}});
    truth::Snapshot snapshot = scene.snapshot();
    traffic::Observation observation;
    double square = 0.0;
    for (int second = 0; second < 2000; ++second) {
        snapshot.time = core::Seconds(second);
        sensor->observe(snapshot, scene.roster(), observation);
        const float true_m = snapshot.x_m[scene.row("h1")];
        square += std::pow(find(observation, scene.key("h1"))->state.x_m - true_m, 2);
    }
    EXPECT_NEAR(std::sqrt(square / 2000.0), 2.0, 0.1);
    EXPECT_FALSE(observation.roster->find(scene.key("h1"))->route.exists());
    EXPECT_TRUE(observation.roster->find(scene.key("a1"))->route.exists());
}

TEST(SeenVehicles, AreNotInTheFailureLogAndTheOthersWereNeverSeen) {
    const support::Scene scene(R"(
        10 m per cell
        ..h.a..........h
    )");
    FailureConfig config = unequipped();
    config.onboard_range_m = 60.0;
    const auto sensor = make_sensor(config, draws(), {scene.network(), {}});
    truth::Snapshot snapshot = scene.snapshot();
    traffic::Observation observation;
    FailureLog log;
    graph::ProximityBuilder builder;
    graph::ProximityGraph links;
    const auto log_at = [&](double time_s) {
        snapshot.time = core::Seconds(time_s);
        sensor->observe(snapshot, scene.roster(), observation);
        builder.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, {}, links);
        sensor->log_failures(snapshot, links, log);
    };
    for (int second = 0; second < 100; ++second) {
        log_at(second);
        EXPECT_THAT(log.never_seen, ::testing::ElementsAre(scene.key("h2")));
        EXPECT_TRUE(log.dark.empty());
        EXPECT_TRUE(log.lost_links.empty());
    }
    snapshot.x_m[scene.row("a1")] += 100.0F;  // a1 goes on: h1 is out of sight, h2 in it and linked.
    log_at(100.0);
    EXPECT_THAT(log.never_seen, ::testing::IsEmpty());
    EXPECT_THAT(log.dark, ::testing::ElementsAre(scene.key("h1")));
}

TEST(LinkDetection, NeedsALineOfSightWhenOcclusionCounts) {
    const support::Scene scene(R"(
        10 m per cell
        h..h.a.....
    )");
    const auto links_of = [&](Occlusion occlusion, double range_m) {
        FailureConfig now = failure_from("link_detection_rate=1");
        now.occlusion = occlusion;
        now.link_detection_range_m = range_m;
        const auto heard_once = make_sensor(now, draws(), {scene.network(), {.radius_m = 80.0}});
        traffic::Observation observation;
        truth::Snapshot snapshot = scene.snapshot();
        heard_once->observe(snapshot, scene.roster(), observation);
        EXPECT_TRUE(observation.detected_links.empty()) << "nobody is dark";
        now.dark_share = 0.9;  // The same keys: dark in some later round.
        const auto sensor = make_sensor(now, draws(), {scene.network(), {.radius_m = 80.0}});
        std::size_t most = 0;
        for (int second = 100; second < 400; ++second) {
            snapshot.time = core::Seconds(second);
            sensor->observe(snapshot, scene.roster(), observation);
            most = std::max(most, observation.detected_links.size());
        }
        return most;
    };
    EXPECT_EQ(links_of(Occlusion::ignored, 1000.0), 2u) << "a1 with h1 and h2";
    EXPECT_EQ(links_of(Occlusion::considered, 1000.0), 1u) << "h1 is behind h2";
    EXPECT_EQ(links_of(Occlusion::ignored, 30.0), 1u) << "h1 is 50 m away";
    EXPECT_EQ(links_of(Occlusion::ignored, 0.0), 0u);
}

TEST(EmergencySensors, SeeWithoutAnyReportWhatNothingHides) {
    const support::Scene scene(R"(
        10 m per cell
        e..h..h..........h
        ...a..............
    )");
    FailureConfig config;
    config.loss_rate = 1.0;  // No report of anybody arrives.
    config.emergency_sensor_range_m = 80.0;
    const traffic::Observation seen = observe(scene, config);
    EXPECT_NE(find(seen, scene.key("h1")), nullptr);
    EXPECT_NE(find(seen, scene.key("a1")), nullptr) << "on the other lane";
    EXPECT_EQ(find(seen, scene.key("h2")), nullptr) << "60 m, but behind h1";
    EXPECT_EQ(find(seen, scene.key("h3")), nullptr) << "170 m";
    EXPECT_EQ(find(seen, scene.key("e1")), nullptr) << "it does not see itself";
    ASSERT_EQ(seen.own_states.size(), 1u) << "but knows itself";
    EXPECT_FLOAT_EQ(find(seen, scene.key("h1"))->position_sigma_m, 0.5F);
    config.emergency_sensor_range_m = 0.0;
    EXPECT_TRUE(observe(scene, config).vehicles.empty());
}

TEST(EmergencyReports, FailAsThoseOfOthersUnlessToldOtherwise) {
    testing::Crowd crowd(200);
    const auto heard_emergency = [&](const char* failure) {
        const auto sensor =
            make_sensor(failure_from(failure), draws(), {testing::small_scene().network(), {}});
        traffic::Observation observation;
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        return std::ranges::count(observation.vehicles, traffic::VehicleClass::emergency,
                                  &traffic::ObservedVehicle::vehicle_class);
    };
    const auto all = std::ranges::count(crowd.snapshot.vehicle_class, traffic::VehicleClass::emergency);
    ASSERT_GT(all, 5);
    EXPECT_LT(heard_emergency("dark_share=0.9"), all);
    EXPECT_EQ(heard_emergency("dark_share=0.9,emergency_dark=no"), all);
}

TEST(DarkCommands, AreLostForThoseWhoseReportWasLost) {
    testing::Crowd crowd(100);
    FailureConfig config = failure_from("B10,dark_commands=lost");
    const LossProcess loss(config, draws());
    const auto sensor = make_sensor(config, draws(), {testing::small_scene().network(), {}});
    const auto kept = make_sensor(failure_from("B10"), draws(), {testing::small_scene().network(), {}});
    traffic::Observation observation;
    std::size_t unreachable = 0;
    for (int second = 0; second < 60; ++second) {
        crowd.at(second);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        std::vector<core::VehicleKey> expected;
        for (const core::VehicleKey key : crowd.snapshot.key) {
            if (loss.lost(key, static_cast<ReportNumber>(second))) expected.push_back(key);
        }
        EXPECT_THAT(sensor->unreachable(), ::testing::ElementsAreArray(expected));
        unreachable += expected.size();
        kept->observe(crowd.snapshot, crowd.roster, observation);
        EXPECT_TRUE(kept->unreachable().empty());
    }
    EXPECT_NEAR(static_cast<double>(unreachable) / 6000.0, 0.3, 0.06);
}

TEST(DarkCommands, ReachWhoStandsBesideTheRoad) {
    testing::Crowd crowd(1);
    crowd.snapshot.beside_road = {{core::vehicle_key("parked"), traffic::VehicleClass::automated, {}}};
    const auto sensor = make_sensor(failure_from("loss_rate=1,dark_commands=lost"), draws(),
                                    {testing::small_scene().network(), {}});
    traffic::Observation observation;
    crowd.at(0);
    sensor->observe(crowd.snapshot, crowd.roster, observation);
    EXPECT_THAT(sensor->unreachable(), ::testing::ElementsAreArray(crowd.snapshot.key))
        << "who sends no reports has lost none";
}

TEST(NewParts, ComposeWithoutChangingEachOthersDraws) {
    // The reports of those that report are the same whoever else is seen.
    testing::Crowd crowd(100);
    for (std::size_t row = 0; row < crowd.snapshot.size(); row += 2) {
        crowd.snapshot.vehicle_class[row] = traffic::VehicleClass::human;
    }
    const auto plain = make_sensor(failure_from("D3B10,connected_share=0.4"), draws(),
                                   {testing::small_scene().network(), {}});
    const auto rich = make_sensor(
        failure_from(
            "D3B10,connected_share=0.4,onboard_range_m=50,roadside_range_m=100,occlusion=considered"),
        draws(), {testing::small_scene().network(), {}});
    traffic::Observation one;
    traffic::Observation other;
    std::size_t seen = 0;
    for (int step = 0; step < 240; ++step) {
        crowd.at(0.25 * step);
        plain->observe(crowd.snapshot, crowd.roster, one);
        rich->observe(crowd.snapshot, crowd.roster, other);
        EXPECT_EQ(one.is_report, other.is_report);
        seen += other.vehicles.size() - one.vehicles.size();
        for (const traffic::ObservedVehicle& vehicle : one.vehicles) {
            if (vehicle.freshness != traffic::Freshness::fresh) continue;
            const traffic::ObservedVehicle* const same = find(other, vehicle.key);
            ASSERT_NE(same, nullptr);
            EXPECT_EQ(same->state.x_m, vehicle.state.x_m);
            EXPECT_EQ(same->age_s, vehicle.age_s);
        }
    }
    EXPECT_GT(seen, 1000u);
}

class NewPartsAtStep : public ::testing::TestWithParam<double> {};

TEST_P(NewPartsAtStep, DoNotDependOnTheStepLength) {
    const auto positions = [](double step_s) {
        const auto sensor =
            make_sensor(failure_from("B10,connected_share=0.3,onboard_range_m=60,onboard_sigma_m=1,"
                                     "speed_sigma_mps=1,speed_correlation_s=5,report_interval_s=0.5"),
                        draws(), {testing::small_scene().network(), {}});
        truth::Snapshot snapshot = testing::small_scene().snapshot();
        traffic::Observation observation;
        std::vector<float> found;
        for (int step = 0; step * step_s < 30.0 - 1e-9; ++step) {
            snapshot.time = core::Seconds(step * step_s);
            sensor->observe(snapshot, testing::small_scene().roster(), observation);
            if (!observation.is_report) continue;
            for (const traffic::ObservedVehicle& vehicle : observation.vehicles) {
                found.insert(found.end(), {vehicle.state.x_m, vehicle.state.speed_mps, vehicle.age_s});
            }
        }
        return found;
    };
    EXPECT_EQ(positions(GetParam()), positions(0.5));
    EXPECT_GT(positions(0.5).size(), 300u);
}

INSTANTIATE_TEST_SUITE_P(Steps, NewPartsAtStep, ::testing::Values(0.1, 0.25));

}  // namespace
}  // namespace clearway::sensing
