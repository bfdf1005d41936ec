// What a recorder counts of safety, comfort and flow, in scenes small enough to work out by hand.
#include <gmock/gmock.h>

#include "metrics/recorder.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using core::LaneIndex;
using core::SignalIndex;
using traffic::VehicleClass;

/// Lanes 0 and 1 lead to signal 0 (links 0 and 1), lanes 2 and 3 are their ways across the junction, lane 4
/// leaves it.
RoadLayout safety_crossing() {
    RoadLayout layout;
    layout.approaches = {{"main", SignalIndex{0}}, {"side", SignalIndex{0}}};
    layout.approach_of_lane = {0, 1, RoadLayout::no_approach, RoadLayout::no_approach,
                               RoadLayout::no_approach};
    layout.internal_lane = {0, 0, 1, 1, 0};
    layout.limit_of_lane_mps = {10.0F, 10.0F, 10.0F, 10.0F, 10.0F};
    layout.signal_ways = {{LaneIndex{2}, LaneIndex::none(), SignalIndex{0}, 0},
                          {LaneIndex{3}, LaneIndex::none(), SignalIndex{0}, 1},
                          {LaneIndex{4}, LaneIndex{0}, SignalIndex{0}, 0},
                          {LaneIndex{4}, LaneIndex{1}, SignalIndex{0}, 1}};
    layout.demand_until_s = 60.0;
    return layout;
}

struct Vehicle {
    std::string id;
    VehicleClass vehicle_class = VehicleClass::human;
    std::uint32_t lane = 0;
    float position_m = 0.0F;
    float speed_mps = 10.0F;
    float acceleration_mps2 = 0.0F;
    float x_m = 0.0F;
    float y_m = 0.0F;
};

class Safety : public testing::Test {
  protected:
    Safety() { recorder_.watch(safety_crossing()); }

    void step(double time_s, std::vector<Vehicle> vehicles, const std::string& signal = "rr") {
        std::ranges::sort(vehicles, {}, [](const Vehicle& one) { return core::vehicle_key(one.id); });
        truth::Snapshot snapshot;
        snapshot.time = core::Seconds(time_s);
        snapshot.resize(vehicles.size());
        for (std::size_t row = 0; row < vehicles.size(); ++row) {
            const Vehicle& vehicle = vehicles[row];
            snapshot.key[row] = core::vehicle_key(vehicle.id);
            snapshot.vehicle_class[row] = vehicle.vehicle_class;
            snapshot.lane[row] = LaneIndex{vehicle.lane};
            snapshot.lane_position_m[row] = vehicle.position_m;
            snapshot.speed_mps[row] = vehicle.speed_mps;
            snapshot.acceleration_mps2[row] = vehicle.acceleration_mps2;
            snapshot.x_m[row] = vehicle.x_m;
            snapshot.y_m[row] = vehicle.y_m;
            if (roster_.find(snapshot.key[row]) == nullptr) {
                traffic::VehicleInfo info;  // 5 m long
                info.key = snapshot.key[row];
                info.id = vehicle.id;
                roster_.add(info);
            }
        }
        snapshot.signals.state = {signal};
        recorder_.step(snapshot, roster_, {}, {});
    }
    RunMetrics metrics() {
        RunEnd end;
        end.tripinfo_files = {folder_.write("tripinfo.xml", "<tripinfos></tripinfos>")};
        return recorder_.finish(end).metrics;
    }

  private:
    traffic::Roster roster_;
    Recorder recorder_;
    support::TemporaryFolder folder_;
};

Vehicle emergency(std::uint32_t lane, float position_m, float speed_mps) {
    return {"ev", VehicleClass::emergency, lane, position_m, speed_mps};
}

TEST_F(Safety, MeasuresTheTimeToCollisionWithTheOneAhead) {
    // 20 m from front to rear (25 m less 5 m), closing at 8 m/s.
    step(0.0, {emergency(0, 50.0F, 12.0F), {"h", VehicleClass::human, 0, 75.0F, 4.0F}});
    EXPECT_DOUBLE_EQ(*metrics().emergency_least_ttc_s, 2.5);
    EXPECT_DOUBLE_EQ(*metrics().emergency_greatest_drac_mps2, 64.0 / 40.0);
    EXPECT_EQ(metrics().emergency_conflicts, 0U);
}

TEST_F(Safety, CountsALastingConflictOnceAndANewOneAgain) {
    const Vehicle ahead{"h", VehicleClass::human, 0, 65.0F, 0.0F};
    double time_s = 0.0;
    for (const float speed_mps : {10.0F, 9.0F, 1.0F, 10.0F})  // 1.0, 1.1, 10, 1.0 s
        step(time_s += 1.0, {emergency(0, 50.0F, speed_mps), ahead});
    EXPECT_EQ(metrics().emergency_conflicts, 2U);
    EXPECT_DOUBLE_EQ(*metrics().emergency_least_ttc_s, 1.0);
}

TEST_F(Safety, SeesAConflictOnlyWhereOneComesNearerWithinOneAndAHalfSeconds) {
    const auto meet = [&](float speed_mps) {
        step(0.0, {emergency(0, 50.0F, 10.0F), {"h", VehicleClass::human, 0, 70.0F, speed_mps}});
    };
    meet(10.0F);
    EXPECT_FALSE(metrics().emergency_least_ttc_s);
    meet(9.5F);
    EXPECT_DOUBLE_EQ(*metrics().emergency_least_ttc_s, 30.0);
    meet(0.0F);
    EXPECT_DOUBLE_EQ(*metrics().emergency_least_ttc_s, 1.5);
    EXPECT_EQ(metrics().emergency_conflicts, 0U);
}

TEST_F(Safety, SeesNoConflictAcrossLanesFarFromAnEvOrSideBySide) {
    step(0.0, {emergency(0, 50.0F, 10.0F),
               {"other_lane", VehicleClass::human, 1, 56.0F, 0.0F},
               {"beside", VehicleClass::human, 0, 53.0F, 0.0F},
               {"far", VehicleClass::human, 4, 0.0F, 10.0F, 0.0F, 500.0F},
               {"far_ahead", VehicleClass::human, 4, 6.0F, 0.0F, 0.0F, 506.0F}});
    EXPECT_FALSE(metrics().emergency_least_ttc_s);
    EXPECT_EQ(metrics().emergency_conflicts, 0U);
}

TEST_F(Safety, CountsConflictsOfOthersNearAnEv) {
    const auto conflicts = [&](float away_m) {
        step(0.0, {{"ev", VehicleClass::emergency, 1, 50.0F, 10.0F, 0.0F, 500.0F, 800.0F},
                   {"h1", VehicleClass::human, 0, 50.0F, 10.0F, 0.0F, 500.0F, 800.0F + away_m},
                   {"h2", VehicleClass::human, 0, 60.0F, 5.0F, 0.0F, 500.0F, 800.0F + away_m}});
        return metrics().emergency_conflicts;
    };
    EXPECT_EQ(conflicts(100.0F), 0U);
    EXPECT_EQ(conflicts(99.0F), 1U);
}

TEST_F(Safety, TakesVehiclesThatTouchForNoConflict) {
    step(0.0, {emergency(0, 50.0F, 10.0F), {"h", VehicleClass::human, 0, 55.0F, 0.0F}});
    EXPECT_FALSE(metrics().emergency_least_ttc_s);
    EXPECT_FALSE(metrics().emergency_greatest_drac_mps2);
    step(1.0, {emergency(0, 50.0F, 10.0F), {"h", VehicleClass::human, 0, 55.5F, 0.0F}});
    EXPECT_DOUBLE_EQ(*metrics().emergency_least_ttc_s, 0.05);
}

TEST_F(Safety, CountsPassagesOfRedByClassAndPassagesOfDemandByTheHour) {
    const Vehicle waits{"h2", VehicleClass::human, 0};
    step(0.0,
         {emergency(0, 99.0F, 10.0F), {"h1", VehicleClass::human, 1}, waits, {"h3", VehicleClass::human, 1}});
    // The EV and h3 cross on red; h1 jumps over the junction on red.
    step(1.0,
         {emergency(2, 1.0F, 10.0F), {"h1", VehicleClass::human, 4}, waits, {"h3", VehicleClass::human, 3}});
    // The letter changes in the step in which h2 crosses: no passage of red.
    step(2.0, {emergency(4, 1.0F, 10.0F), {"h1", VehicleClass::human, 4}, {"h2", VehicleClass::human, 2}},
         "Gr");
    const RunMetrics found = metrics();
    EXPECT_EQ(found.emergency_red_passages, 1U);
    EXPECT_EQ(found.others_red_passages, 2U);
    EXPECT_DOUBLE_EQ(*found.signal_throughput_per_hour, 4.0 / 2.0 * 3600.0);
}

TEST_F(Safety, CountsHardBrakingOfOthersOnceAndTheirJerk) {
    // In steps of 0.5 s: 0, -4, -4, 0 m/s^2: jerks of 8, 0 and 8 m/s^3. The EV brakes harder and counts not.
    double time_s = 0.0;
    const auto drive = [&](float acceleration_mps2) {
        step(time_s += 0.5, {{"ev", VehicleClass::emergency, 1, 0.0F, 10.0F, 2.0F * acceleration_mps2},
                             {"a", VehicleClass::automated, 0, 0.0F, 10.0F, acceleration_mps2}});
    };
    drive(0.0F);
    EXPECT_FALSE(metrics().others_jerk_mps3);
    drive(-4.0F);
    EXPECT_DOUBLE_EQ(*metrics().others_jerk_mps3, 8.0);
    drive(-4.0F);
    drive(0.0F);
    EXPECT_EQ(metrics().others_hard_brakings, 1U);
    EXPECT_DOUBLE_EQ(*metrics().others_jerk_mps3, std::sqrt(128.0 / 3.0));
}

TEST_F(Safety, CallsBrakingHardAboveItsLimit) {
    double time_s = 0.0;
    const auto brakings = [&](float acceleration_mps2) {
        step(time_s += 0.5, {{"h", VehicleClass::human, 0, 0.0F, 10.0F, acceleration_mps2}});
        return metrics().others_hard_brakings;
    };
    EXPECT_EQ(brakings(0.0F), 0U);
    EXPECT_EQ(brakings(-3.4F), 0U);
    EXPECT_EQ(brakings(-3.5F), 1U);
}

TEST_F(Safety, MeasuresFlowsToTheLastMomentOfDemand) {
    const Vehicle queue{"h1", VehicleClass::human, 0, 99.0F, 0.0F};
    step(59.0, {queue, {"h2", VehicleClass::human, 1}, {"h3", VehicleClass::human, 1}});
    step(60.0, {queue, {"h2", VehicleClass::human, 3}, {"h3", VehicleClass::human, 1}});
    step(61.0, {queue, {"h2", VehicleClass::human, 4}, {"h3", VehicleClass::human, 3}});
    EXPECT_DOUBLE_EQ(*metrics().signal_throughput_per_hour, 3600.0);
    EXPECT_DOUBLE_EQ(*metrics().signal_queue_vehicles, 1.0 / 2.0);
}

TEST_F(Safety, AveragesQueuesOverApproachesAndTheTimeOfDemand) {
    const Vehicle first{"h1", VehicleClass::human, 0, 99.0F, 0.0F};
    const Vehicle second{"h2", VehicleClass::human, 0, 90.0F, 0.0F};
    const Vehicle creeps{"h3", VehicleClass::human, 0, 80.0F, 0.1F};
    step(0.0, {});
    EXPECT_FALSE(metrics().signal_queue_vehicles);
    EXPECT_FALSE(metrics().signal_throughput_per_hour);
    step(1.0, {first});
    step(2.0, {first, second, creeps});
    step(100.0, {first});  // Demand is over.
    EXPECT_DOUBLE_EQ(*metrics().signal_queue_vehicles, (1.0 + 2.0) / 2.0 / 2.0);
    EXPECT_DOUBLE_EQ(*metrics().signal_longest_queue_vehicles, 2.0);
}

TEST_F(Safety, NamesTheDelayOfTheWorstApproachThatFiveVehiclesUse) {
    std::vector<Vehicle> vehicles = {{"side", VehicleClass::human, 1, 0.0F, 0.0F}};
    for (int number = 0; number < 5; ++number)
        vehicles.push_back({"main" + std::to_string(number), VehicleClass::human, 0, 0.0F, 5.0F});
    step(0.0, vehicles);
    step(4.0, vehicles);
    EXPECT_DOUBLE_EQ(*metrics().worst_approach_delay_s, 2.0) << "half the limit for 4 s";
}

TEST(SafetyUnwatched, IsEmptyWhereNothingWasWatched) {
    const RunMetrics metrics = Recorder().finish({}).metrics;
    EXPECT_FALSE(metrics.emergency_least_ttc_s);
    EXPECT_FALSE(metrics.signal_throughput_per_hour);
    EXPECT_FALSE(metrics.worst_approach_delay_s);
}

}  // namespace
}  // namespace clearway::metrics
