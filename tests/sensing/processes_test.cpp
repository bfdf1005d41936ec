#include "sensing/processes.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {

using namespace failures;

namespace {

using testing::draws;

constexpr int vehicles = 200;
constexpr int reports = 3000;

core::VehicleKey key_of(int number) {
    return core::vehicle_key("vehicle" + std::to_string(number));
}

struct OutageStatistics {
    double dark_share = 0.0;
    double mean_outage_s = 0.0;
};

/// Counts outages that begin and end inside the span, so that none is cut.
OutageStatistics outages(const LossProcess& process, double interval_s) {
    int dark = 0;
    int ended = 0;
    int length_of_ended = 0;
    for (int vehicle = 0; vehicle < vehicles; ++vehicle) {
        int length = -1;  // Unknown: the first outage may have begun before.
        for (int report = 1; report <= reports; ++report) {
            const bool now = process.in_outage(key_of(vehicle), static_cast<ReportNumber>(report));
            dark += now ? 1 : 0;
            if (now) {
                if (length >= 0) ++length;
            } else {
                if (length > 0) {
                    ++ended;
                    length_of_ended += length;
                }
                length = 0;
            }
        }
    }
    return {static_cast<double>(dark) / (vehicles * reports), interval_s * length_of_ended / ended};
}

TEST(LossProcess, LosesTheConfiguredShareIndependently) {
    const LossProcess process(failure_from("A.3"), draws());
    int lost = 0;
    int lost_twice = 0;
    for (int vehicle = 0; vehicle < vehicles; ++vehicle) {
        for (ReportNumber report = 0; report < reports; ++report) {
            const bool now = process.lost(key_of(vehicle), report);
            lost += now ? 1 : 0;
            lost_twice += now && process.lost(key_of(vehicle), report + 1) ? 1 : 0;
        }
    }
    // 600,000 draws: standard error of the share 0.0006.
    EXPECT_NEAR(lost / static_cast<double>(vehicles * reports), 0.3, 0.003);
    EXPECT_NEAR(lost_twice / static_cast<double>(vehicles * reports), 0.09, 0.003);
}

TEST(LossProcess, HasTheConfiguredOutagesWhateverTheInterval) {
    for (const double interval_s : {1.0, 0.5, 0.1}) {
        for (const char* name : {"B5", "B10", "B20"}) {
            FailureConfig config = failure_from(name);
            config.report_interval_s = interval_s;
            const OutageStatistics found = outages(LossProcess(config, draws()), interval_s);
            // Standard error: outages of a share of time are rare at 0.1 s (about 1,700 of B20), hence 6 %.
            EXPECT_NEAR(found.dark_share, 0.3, 0.02) << name << " at " << interval_s;
            EXPECT_NEAR(found.mean_outage_s / config.mean_outage_s, 1.0, 0.08)
                << name << " at " << interval_s;
        }
    }
}

TEST(LossProcess, StaysInTheLimitOfIndependentLoss) {
    FailureConfig config;
    config.dark_share = 0.9;
    config.mean_outage_s = 10.0;  // The shortest that 0.9 allows at 1 s.
    ASSERT_TRUE(problems_of(config, "f").empty());
    const OutageStatistics found = outages(LossProcess(config, draws()), 1.0);
    EXPECT_NEAR(found.dark_share, 0.9, 0.005);
    EXPECT_NEAR(found.mean_outage_s, 10.0, 0.2);
}

TEST(LossProcess, IsAFunctionOfVehicleAndNumberAlone) {
    const LossProcess forwards(failure_from("B10"), draws());
    const LossProcess backwards(failure_from("B10"), draws());
    std::vector<bool> expected;
    for (ReportNumber report = 0; report < 500; ++report) {
        expected.push_back(forwards.lost(key_of(7), report));
    }
    for (ReportNumber report = 500; report-- > 0;) {
        EXPECT_EQ(backwards.lost(key_of(7), report), expected[report]) << report;
    }
}

TEST(LossProcess, DiffersBetweenReplicationsAndVehicles) {
    const LossProcess one(failure_from("A.5"), draws(1, 0));
    const LossProcess other(failure_from("A.5"), draws(1, 1));
    int same_vehicle = 0;
    int same_replication = 0;
    for (ReportNumber report = 0; report < 1000; ++report) {
        same_vehicle += one.lost(key_of(1), report) == other.lost(key_of(1), report) ? 1 : 0;
        same_replication += one.lost(key_of(1), report) == one.lost(key_of(2), report) ? 1 : 0;
    }
    EXPECT_NEAR(same_vehicle, 500, 80);
    EXPECT_NEAR(same_replication, 500, 80);
}

/// Errors of one vehicle's x at consecutive reports.
std::vector<double> position_errors(const FailureConfig& config, int vehicle) {
    const NoiseProcess process(config, draws(), testing::small_scene().network());
    std::vector<double> errors;
    for (ReportNumber report = 1000; report < 1400; ++report) {
        traffic::MotionState state;
        process.apply(key_of(vehicle), report, state);
        errors.push_back(state.x_m);
    }
    return errors;
}

struct Moments {
    double deviation = 0.0;
    double correlation = 0.0;
};
Moments moments(const FailureConfig& config) {
    double square = 0.0;
    double product = 0.0;
    int count = 0;
    for (int vehicle = 0; vehicle < 100; ++vehicle) {
        const std::vector<double> errors = position_errors(config, vehicle);
        for (std::size_t at = 1; at < errors.size(); ++at) {
            square += errors[at] * errors[at];
            product += errors[at] * errors[at - 1];
            ++count;
        }
    }
    return {std::sqrt(square / count), product / square};
}

TEST(NoiseProcess, IsWhiteWithTheStatedDeviation) {
    const Moments found = moments(failure_from("D3"));
    EXPECT_NEAR(found.deviation, 3.0, 0.06);
    EXPECT_NEAR(found.correlation, 0.0, 0.02);
}

TEST(NoiseProcess, ForgetsItselfInTheStatedTime) {
    FailureConfig config = failure_from("D3");
    config.position_correlation_s = 10.0;
    const Moments found = moments(config);
    EXPECT_NEAR(found.deviation, 3.0, 0.2);
    EXPECT_NEAR(found.correlation, std::exp(-0.1), 0.02);
}

TEST(NoiseProcess, MovesThePlaceOnTheMapWithThePosition) {
    const support::Scene& scene = testing::small_scene();
    const NoiseProcess process(failure_from("D5"), draws(), scene.network());
    const traffic::MotionState before = scene.snapshot().motion(scene.row("a1"));
    int other_lane = 0;
    for (ReportNumber report = 0; report < 200; ++report) {
        traffic::MotionState after = before;
        process.apply(scene.key("a1"), report, after);
        const roads::Lane& lane = scene.network().lane(after.lane);
        EXPECT_EQ(lane.edge, scene.network().lane(before.lane).edge);
        EXPECT_NEAR(after.lane_position_m - before.lane_position_m, after.x_m - before.x_m, 1e-3);
        other_lane += after.lane != before.lane ? 1 : 0;
        // The upper lane is lane 1: to the right by more than half a lane is lane 0.
        EXPECT_EQ(lane.number, after.y_m - before.y_m < -0.5F * lane.width_m ? 0u : 1u);
    }
    EXPECT_GT(other_lane, 30);
}

TEST(NoiseProcess, NeverReportsANegativeSpeed) {
    FailureConfig config;
    config.speed_sigma_mps = 2.0;
    const NoiseProcess process(config, draws(), testing::small_scene().network());
    int moved = 0;
    for (ReportNumber report = 0; report < 200; ++report) {
        traffic::MotionState state;
        process.apply(key_of(1), report, state);
        EXPECT_GE(state.speed_mps, 0.0F);
        moved += state.speed_mps > 0.0F ? 1 : 0;
    }
    EXPECT_NEAR(moved, 100, 40);
}

TEST(NoiseProcess, CorrelatesSpeedErrorsAsStatedApartFromPositionErrors) {
    FailureConfig config;
    config.speed_sigma_mps = 2.0;
    config.speed_correlation_s = 5.0;
    config.position_sigma_m = 3.0;
    const NoiseProcess process(config, draws(), testing::small_scene().network());
    double square = 0.0;
    double product = 0.0;
    double with_position = 0.0;
    int count = 0;
    for (int vehicle = 0; vehicle < 100; ++vehicle) {
        double before = 0.0;
        for (ReportNumber report = 500; report < 900; ++report) {
            traffic::MotionState state;
            state.speed_mps = 50.0F;
            process.apply(key_of(vehicle), report, state);
            const double error = state.speed_mps - 50.0;
            square += error * error;
            with_position += error * state.x_m;
            if (report > 500) product += error * before;
            before = error;
            ++count;
        }
    }
    EXPECT_NEAR(std::sqrt(square / count), 2.0, 0.1);
    EXPECT_NEAR(product / square, std::exp(-0.2), 0.02);
    EXPECT_NEAR(with_position / count / 6.0, 0.0, 0.02);
}

TEST(EquipmentProcess, EquipsTheShareOfHumanDriversAndEverybodyElse) {
    int equipped = 0;
    FailureConfig few;
    few.connected_share = 0.2;
    FailureConfig config;
    config.connected_share = 0.3;
    const EquipmentProcess process(config, draws());
    const EquipmentProcess fewer(few, draws());
    for (int vehicle = 0; vehicle < 10000; ++vehicle) {
        const bool now = process.equipped(key_of(vehicle), traffic::VehicleClass::human);
        equipped += now ? 1 : 0;
        EXPECT_TRUE(process.equipped(key_of(vehicle), traffic::VehicleClass::automated));
        EXPECT_TRUE(process.equipped(key_of(vehicle), traffic::VehicleClass::emergency));
        EXPECT_TRUE(now || !fewer.equipped(key_of(vehicle), traffic::VehicleClass::human));
    }
    EXPECT_NEAR(equipped / 10000.0, 0.3, 0.015);  // Standard error 0.0046.
}

TEST(DetectionProcess, KeepsToItsRange) {
    FailureConfig config = failure_from("C.link");
    config.link_detection_range_m = 20.0;
    const DetectionProcess process(config, draws());
    EXPECT_TRUE(process.in_range(19.9F));
    EXPECT_FALSE(process.in_range(20.0F));
    EXPECT_TRUE(DetectionProcess(failure_from("C.link"), draws()).in_range(49.9F));
}

TEST(DetectionProcess, TreatsBothEndsAlike) {
    const DetectionProcess process(failure_from("C.range"), draws());
    int detected = 0;
    double square = 0.0;
    for (ReportNumber report = 0; report < 4000; ++report) {
        EXPECT_EQ(process.detected(key_of(1), key_of(2), report),
                  process.detected(key_of(2), key_of(1), report));
        EXPECT_EQ(process.range_m(key_of(1), key_of(2), report, 30.0F),
                  process.range_m(key_of(2), key_of(1), report, 30.0F));
        detected += process.detected(key_of(1), key_of(2), report) ? 1 : 0;
        square += std::pow(process.range_m(key_of(1), key_of(2), report, 30.0F) - 30.0, 2);
    }
    EXPECT_NEAR(detected / 4000.0, 0.5, 0.03);
    EXPECT_NEAR(std::sqrt(square / 4000.0), 1.0, 0.05);
    const DetectionProcess presence(failure_from("C.link"), draws());
    EXPECT_LT(presence.range_m(key_of(1), key_of(2), 0, 30.0F), 0.0F);
}

}  // namespace
}  // namespace clearway::sensing
