#include "drivers/listeners.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/ascii_scene.hpp"

namespace clearway::testing {
namespace {

const core::KeyedRandom listener_random(core::StudySeed{1}, core::Replication{0});

constexpr const char* listener_road = R"(
    10 m per cell, limit 20 m/s, speed 10 m/s
    ..e..h....a......................h
)";

drivers::RequestConfig everybody_asked() {
    drivers::RequestConfig config;
    config.compliance = 1.0;
    config.reaction_mean_s = 1.0;
    config.reaction_deviation_s = 0.0;
    return config;
}

std::vector<core::VehicleKey> after(drivers::Listeners& listeners, support::Scene& scene, double duration_s) {
    std::vector<core::VehicleKey> ready;
    for (double passed_s = 0.0; passed_s <= duration_s; passed_s += 0.5) {
        const auto now = listeners.step(scene.snapshot());
        ready.assign(now.begin(), now.end());
        scene.pass(core::Seconds(0.5));
    }
    return ready;
}

TEST(Listeners, are_human_drivers_within_hearing_after_their_reaction_time) {
    support::Scene scene(listener_road);
    drivers::Listeners listeners(listener_random, everybody_asked());
    EXPECT_TRUE(after(listeners, scene, 0.5).empty()) << "nobody has reacted yet";
    EXPECT_EQ(after(listeners, scene, 1.0), std::vector{scene.key("h1")}) << "h2 is 310 m away";
}

TEST(Listeners, are_nobody_where_nobody_complies) {
    support::Scene scene(listener_road);
    drivers::RequestConfig config = everybody_asked();
    config.compliance = 0.0;
    drivers::Listeners listeners(listener_random, config);
    EXPECT_TRUE(after(listeners, scene, 5.0).empty());
}

TEST(Listeners, are_a_share_of_the_drivers_that_grows_by_the_same_drivers) {
    truth::Snapshot snapshot;
    std::vector<std::pair<core::VehicleKey, bool>> vehicles = {{core::vehicle_key("e"), true}};
    for (int number = 0; number < 400; ++number)
        vehicles.emplace_back(core::vehicle_key("h" + std::to_string(number)), false);
    std::ranges::sort(vehicles);
    for (const auto& [key, is_emergency] : vehicles) {
        snapshot.key.push_back(key);
        snapshot.vehicle_class.push_back(is_emergency ? traffic::VehicleClass::emergency
                                                      : traffic::VehicleClass::human);
        snapshot.x_m.push_back(0.0F);
        snapshot.y_m.push_back(0.0F);
    }
    std::vector<core::VehicleKey> fewer;
    for (const double compliance : {0.25, 0.5, 0.75}) {
        drivers::RequestConfig config = everybody_asked();
        config.compliance = compliance;
        drivers::Listeners listeners(listener_random, config);
        snapshot.time = core::Seconds(0.0);
        listeners.step(snapshot);
        snapshot.time = core::Seconds(2.0);
        const auto ready = listeners.step(snapshot);
        EXPECT_NEAR(static_cast<double>(ready.size()) / 400.0, compliance, 0.08);
        EXPECT_TRUE(std::ranges::includes(ready, fewer));
        fewer.assign(ready.begin(), ready.end());
    }
}

}  // namespace
}  // namespace clearway::testing
