#include "metrics/detail/cross_watch.hpp"

#include <gmock/gmock.h>

namespace clearway::metrics::detail {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;

/// Lanes 0 (main, of the emergency vehicle) and 1 (side) lead to signal 0, lane 2 to signal 1; 10 m/s.
RoadLayout crossing(const std::vector<double>& earliest_s) {
    RoadLayout layout;
    layout.approaches = {
        {"main", core::SignalIndex{0}}, {"side", core::SignalIndex{0}}, {"elsewhere", core::SignalIndex{1}}};
    layout.approach_of_lane = {0, 1, 2};
    layout.limit_of_lane_mps = {10.0F, 10.0F, 10.0F};
    for (const double one_s : earliest_s) {
        WatchedRoute route;
        route.signals = {{core::SignalIndex{0}, "J", {0}, 100.0, one_s, 0}};
        layout.routes.push_back(route);
    }
    return layout;
}

/// A vehicle stands on each lane from 0 s until `end_s`, in steps of 1 s.
std::optional<double> delay_of(const RoadLayout& layout, double end_s,
                               traffic::VehicleClass vehicle_class = traffic::VehicleClass::human) {
    CrossWatch watch(layout);
    for (double now_s = 0.0; now_s <= end_s; now_s += 1.0) {
        truth::Snapshot snapshot;
        snapshot.time = core::Seconds(now_s);
        snapshot.resize(3);
        for (std::uint32_t row = 0; row < 3; ++row) {
            snapshot.key[row] = core::VehicleKey{row + 1};
            snapshot.vehicle_class[row] = vehicle_class;
            snapshot.lane[row] = core::LaneIndex{row};
            snapshot.speed_mps[row] = row == 1 ? 5.0F : 0.0F;
        }
        watch.step(snapshot);
    }
    return watch.delay_s();
}

TEST(CrossWatch, SumsWhatTheCrossStreetLosesInFifteenMinutes) {
    EXPECT_THAT(delay_of(crossing({50.0}), 2000.0), Optional(DoubleNear(901 * 0.5, 1e-6)))
        << "half of each of the steps that end from 50 to 950 s, on the side street alone";
    EXPECT_THAT(delay_of(crossing({50.0}), 99.0), Optional(DoubleNear(50 * 0.5, 1e-6)));
    EXPECT_THAT(delay_of(crossing({0.0}), 10.0), Optional(DoubleNear(10 * 0.5, 1e-6)))
        << "from the first step on";
}

TEST(CrossWatch, CountsOverlappingWindowsOnceAndDividesByThePassages) {
    EXPECT_THAT(delay_of(crossing({50.0, 150.0}), 2000.0), Optional(DoubleNear(1001 * 0.5 / 2, 1e-6)));
    EXPECT_THAT(delay_of(crossing({50.0, 1000.0}), 3000.0), Optional(DoubleNear(901 * 0.5, 1e-6)));
}

TEST(CrossWatch, LeavesOutEmergencyVehiclesAndRoutesWithoutSignals) {
    EXPECT_THAT(delay_of(crossing({50.0}), 2000.0, traffic::VehicleClass::emergency), Optional(0.0));
    EXPECT_EQ(delay_of(crossing({}), 100.0), std::nullopt);
}

}  // namespace
}  // namespace clearway::metrics::detail
