#include "sensing/sensor.hpp"

#include <map>
#include <set>

#include <gmock/gmock.h>

#include "sensing/processes.hpp"
#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {

using namespace failures;

namespace {

using testing::Crowd;
using testing::draws;
using testing::find;
using testing::small_scene;

std::unique_ptr<SensorModel> sensor_of(const FailureConfig& config, std::uint32_t replication = 0) {
    return make_sensor(config, draws(1, replication), {small_scene().network(), {}});
}

/// Report number -> keys that were fresh in that round.
using Heard = std::map<ReportNumber, std::set<core::VehicleKey>>;

Heard heard(const FailureConfig& config, double step_s, Crowd crowd, double start_s = 0.0,
            double end_s = 60.0) {
    const auto sensor = sensor_of(config);
    traffic::Observation observation;
    Heard result;
    for (int step = 0; start_s + step * step_s < end_s; ++step) {
        crowd.at(start_s + step * step_s);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        if (!observation.is_report) continue;
        auto& keys = result[static_cast<ReportNumber>(observation.time.value + 1e-6)];
        for (const traffic::ObservedVehicle& vehicle : observation.vehicles) {
            if (vehicle.freshness == traffic::Freshness::fresh) keys.insert(vehicle.key);
        }
    }
    return result;
}

class LossRateAtStep : public ::testing::TestWithParam<double> {};

TEST_P(LossRateAtStep, ConvergesToTheConfiguredValue) {
    for (const double rate : {0.1, 0.5, 0.7}) {
        FailureConfig config;
        config.loss_rate = rate;
        const Heard rounds = heard(config, GetParam(), Crowd(300));
        EXPECT_EQ(rounds.size(), 60u);
        double lost = 0.0;
        for (const auto& [number, keys] : rounds) {
            lost += 300.0 - static_cast<double>(keys.size());
        }
        EXPECT_NEAR(lost / (60.0 * 300.0), rate, 0.012);  // Standard error 0.0037.
    }
}

TEST_P(LossRateAtStep, LeavesTheDrawsAlone) {
    for (const char* name : {"A.5", "B10", "D3B10"}) {
        EXPECT_EQ(heard(failure_from(name), GetParam(), Crowd(100)),
                  heard(failure_from(name), 1.0, Crowd(100)))
            << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Steps, LossRateAtStep, ::testing::Values(0.1, 0.25, 1.0));

TEST(Sensor, MeetsTheSameFailuresWhoeverElseIsThereAndWheneverItStarts) {
    const Heard all = heard(failure_from("B10"), 1.0, Crowd(100));
    const Heard few = heard(failure_from("B10"), 1.0, Crowd(20, 40), 30.0);
    const Crowd those(20, 40);
    for (const auto& [number, keys] : few) {
        for (const core::VehicleKey key : those.snapshot.key) {
            EXPECT_EQ(keys.contains(key), all.at(number).contains(key)) << number;
        }
    }
    EXPECT_EQ(few.begin()->first, 30u);
}

TEST(Sensor, HoldsRoundsAtTheFirstStepAtOrAfterTheirTime) {
    FailureConfig config;
    const auto sensor = sensor_of(config);
    Crowd crowd(5);
    traffic::Observation observation;
    std::vector<double> times;
    for (int step = 0; step < 12; ++step) {  // Steps of 0.4 s do not divide 1 s.
        crowd.at(0.4 * step);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        if (observation.is_report) times.push_back(observation.time.value);
    }
    EXPECT_THAT(times, ::testing::ElementsAre(0.0, ::testing::DoubleEq(0.4 * 3), ::testing::DoubleEq(0.4 * 5),
                                              ::testing::DoubleEq(0.4 * 8), ::testing::DoubleEq(0.4 * 10)));
}

TEST(Sensor, KeepsTheLastReportAndItsExactAge) {
    const FailureConfig config = failure_from("A.5");
    const LossProcess loss(config, draws());
    const auto sensor = sensor_of(config);
    Crowd crowd(50);
    traffic::Observation observation;
    std::map<core::VehicleKey, double> last;  // The independent account: when each was last heard.
    int stale = 0;
    for (int step = 0; step < 80; ++step) {
        const double time_s = 0.25 * step;
        crowd.at(time_s);
        for (std::size_t row = 0; row < crowd.snapshot.size(); ++row) {
            crowd.snapshot.speed_mps[row] = static_cast<float>(time_s);
            if (step % 4 == 0 && !loss.lost(crowd.snapshot.key[row], static_cast<ReportNumber>(step / 4))) {
                last[crowd.snapshot.key[row]] = time_s;
            }
        }
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        EXPECT_EQ(observation.report_time.value, std::floor(time_s));
        ASSERT_EQ(observation.vehicles.size(), last.size());
        for (const traffic::ObservedVehicle& vehicle : observation.vehicles) {
            EXPECT_EQ(vehicle.age_s, static_cast<float>(time_s - last.at(vehicle.key)));
            EXPECT_EQ(vehicle.state.speed_mps, static_cast<float>(last.at(vehicle.key)));
            EXPECT_EQ(vehicle.freshness == traffic::Freshness::fresh,
                      last.at(vehicle.key) == std::floor(time_s));
            stale += vehicle.freshness == traffic::Freshness::stale ? 1 : 0;
        }
        EXPECT_TRUE(std::ranges::is_sorted(observation.vehicles, {}, &traffic::ObservedVehicle::key));
    }
    EXPECT_GT(stale, 500);
}

TEST(Sensor, LetsEmergencyVehiclesKnowThemselvesAlways) {
    FailureConfig config;
    config.loss_rate = 1.0;
    const auto sensor = sensor_of(config);
    support::Scene const& scene = small_scene();
    truth::Snapshot snapshot = scene.snapshot();
    traffic::Observation observation;
    for (const double time_s : {100.0, 100.25, 103.5}) {
        snapshot.time = core::Seconds(time_s);
        snapshot.speed_mps[scene.row("e1")] = static_cast<float>(time_s);
        sensor->observe(snapshot, scene.roster(), observation);
        EXPECT_TRUE(observation.vehicles.empty());
        ASSERT_EQ(observation.own_states.size(), 1u);
        EXPECT_EQ(observation.own_states[0].key, scene.key("e1"));
        EXPECT_EQ(observation.own_states[0].age_s, 0.0F);
        EXPECT_EQ(observation.own_states[0].state.speed_mps, static_cast<float>(time_s));
        ASSERT_NE(observation.roster->find(scene.key("e1")), nullptr);
        EXPECT_EQ(observation.roster->find(scene.key("a1")), nullptr);
    }
}

TEST(Sensor, ListsRoutesOfThoseThatReportedAndFollowsTheirChanges) {
    const support::Scene& scene = small_scene();
    traffic::Roster roster;
    for (const traffic::VehicleInfo& info : scene.roster().vehicles()) {
        traffic::VehicleInfo copy = info;
        copy.route = roster.add_route(scene.roster().route(info.route));
        roster.add(copy);
    }
    const auto sensor = sensor_of(FailureConfig{});
    truth::Snapshot snapshot = scene.snapshot();
    traffic::Observation observation;
    sensor->observe(snapshot, roster, observation);
    const auto route_of = [&](const char* id) {
        return observation.roster->route(observation.roster->find(scene.key(id))->route);
    };
    EXPECT_EQ(route_of("a1").size(), 2u);
    EXPECT_NE(observation.roster, &roster);

    roster.set_route(scene.key("a1"), roster.add_route({*scene.network().find_edge("road_0")}));
    snapshot.time = core::Seconds(101.0);
    sensor->observe(snapshot, roster, observation);
    EXPECT_EQ(route_of("a1").size(), 1u);
    EXPECT_EQ(route_of("h1").size(), 2u);
}

TEST(Sensor, DropsThoseThatLeftWhenExitsAreKnownAndKeepsThemOtherwise) {
    for (const Exits exits : {Exits::known, Exits::unknown}) {
        FailureConfig config;
        config.exits = exits;
        config.forget_after_s = 5.0;
        const auto sensor = sensor_of(config);
        Crowd crowd(10);
        traffic::Observation observation;
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        const core::VehicleKey gone = crowd.snapshot.key.back();
        crowd.snapshot.resize(9);
        crowd.at(0.25);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        EXPECT_EQ(find(observation, gone) != nullptr, exits == Exits::unknown);
        EXPECT_EQ(observation.exits_known, exits == Exits::known);
        EXPECT_EQ(observation.vehicles.size(), exits == Exits::known ? 9u : 10u);
        crowd.at(5.0);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        EXPECT_EQ(observation.vehicles.size(), exits == Exits::known ? 9u : 10u);
        crowd.at(5.25);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        EXPECT_EQ(observation.vehicles.size(), 9u) << "forgotten after 5 s";
    }
}

TEST(Sensor, DeliversReportsAfterTheirLatency) {
    const auto sensor = sensor_of(failure_from("DL2"));
    Crowd crowd(10);
    traffic::Observation observation;
    for (int step = 0; step < 20; ++step) {
        const double time_s = 0.5 * step;
        crowd.at(time_s);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        if (time_s < 2.0) {
            EXPECT_TRUE(observation.vehicles.empty());
            continue;
        }
        EXPECT_EQ(observation.is_report, step % 2 == 0);
        EXPECT_EQ(observation.report_time.value, std::floor(time_s) - 2.0);
        ASSERT_EQ(observation.vehicles.size(), 10u);
        EXPECT_EQ(observation.vehicles[3].freshness, traffic::Freshness::fresh);
        EXPECT_EQ(observation.vehicles[3].age_s, static_cast<float>(time_s - std::floor(time_s) + 2.0));
    }
}

TEST(Sensor, StatesItsErrorAndMakesIt) {
    const support::Scene& scene = small_scene();
    const auto sensor = sensor_of(failure_from("D3"));
    traffic::Observation observation;
    sensor->observe(scene.snapshot(), scene.roster(), observation);
    ASSERT_EQ(observation.vehicles.size(), 4u);
    for (const traffic::ObservedVehicle& vehicle : observation.vehicles) {
        EXPECT_EQ(vehicle.position_sigma_m, 3.0F);
        EXPECT_NE(vehicle.state.x_m, scene.snapshot().x_m[*scene.snapshot().row_of(vehicle.key)]);
    }
    EXPECT_EQ(observation.own_states[0].state.x_m, scene.snapshot().x_m[scene.row("e1")]);
}

TEST(PerfectSensor, ReportsEverythingAtEveryStep) {
    const support::Scene& scene = small_scene();
    const auto sensor = sensor_of(failure_from("perfect"));
    truth::Snapshot snapshot = scene.snapshot();
    traffic::Observation observation;
    for (const double time_s : {100.0, 100.1, 100.35}) {
        snapshot.time = core::Seconds(time_s);
        sensor->observe(snapshot, scene.roster(), observation);
        EXPECT_TRUE(observation.is_report);
        ASSERT_EQ(observation.vehicles.size(), snapshot.size());
        for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
            EXPECT_EQ(observation.vehicles[row].key, snapshot.key[row]);
            EXPECT_EQ(observation.vehicles[row].age_s, 0.0F);
            EXPECT_EQ(observation.vehicles[row].state.x_m, snapshot.x_m[row]);
            EXPECT_EQ(observation.vehicles[row].state.lane, snapshot.lane[row]);
        }
        EXPECT_EQ(observation.own_states.size(), 1u);
    }
}

TEST(Sensor, CopesWithAnEmptyRoad) {
    for (const FailurePreset& preset : failure_presets()) {
        const auto sensor = sensor_of(preset.config);
        Crowd crowd(0);
        traffic::Observation observation;
        for (int step = 0; step < 5; ++step) {
            crowd.at(step);
            sensor->observe(crowd.snapshot, crowd.roster, observation);
            EXPECT_TRUE(observation.vehicles.empty() && observation.detected_links.empty()) << preset.name;
        }
    }
}

TEST(FailureConfig, ThatIsWrongMakesNoSensor) {
    FailureConfig config;
    config.loss_rate = -0.1;
    config.latency_s = 61.0;
    try {
        make_sensor(config, testing::draws(), {testing::small_scene().network(), {}});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.problems(), ::testing::SizeIs(2));
    }
}

}  // namespace
}  // namespace clearway::sensing
