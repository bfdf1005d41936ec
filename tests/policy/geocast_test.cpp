// geocast: a message to a stretch of road, for vehicles that nobody knows.
#include "policy/geocast.hpp"

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "support/ascii_scene.hpp"

namespace clearway::testing {
namespace {

/// What a geocast asks of vehicles of this class on the road that the drawing shows, by id.
class Broadcast {
  public:
    explicit Broadcast(std::string_view drawing) : scene(drawing) {}

    void send(policy::GeocastConfig config = {}, double at_s = 100.0) {
        traffic::BelievedGraph belief;  // Of others, nothing is known.
        belief.roster = &scene.roster();
        belief.time = core::Seconds(at_s);
        const core::VehicleIndex row = scene.row("e1");
        belief.own_states = {
            {scene.key("e1"), traffic::VehicleClass::emergency, scene.snapshot().motion(row), 0.0F, 0.0F}};
        belief.first_link = {0};
        policy::Geocast policy({scene.network()}, config);
        leases.clear();
        policy.act(belief, leases);
    }
    /// Vehicles that an action of this kind is asked of.
    template <class Action>
    std::set<std::string> asked() const {
        std::set<std::string> ids;
        for (const traffic::Lease& lease : leases) {
            if (!std::holds_alternative<Action>(lease.action)) continue;
            if (const auto* const key = std::get_if<core::VehicleKey>(&lease.target))
                ids.insert(scene.id(*key));
            const auto* const stretch = std::get_if<traffic::Stretch>(&lease.target);
            if (stretch == nullptr) continue;
            for (core::VehicleIndex row = 0; row < scene.snapshot().size(); ++row) {
                if (stretch->has(scene.snapshot().vehicle_class[row], scene.snapshot().motion(row)))
                    ids.insert(scene.id(scene.snapshot().key[row]));
            }
        }
        return ids;
    }

    support::Scene scene;
    std::vector<traffic::Lease> leases;
};

using Ids = std::set<std::string>;

constexpr const char* three_lanes = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    ..a.....a....h.......................a..
    a....e......a...........................
    .........a..............................
)";

TEST(Geocast, clears_the_left_lane_without_knowing_of_anybody) {
    Broadcast road(three_lanes);
    road.send();
    EXPECT_EQ(road.asked<traffic::ChangeLane>(), (Ids{"a2", "e1"}))
        << "a1 is behind, a3 is 320 m ahead, h1 is not asked";
    EXPECT_EQ(road.asked<traffic::HoldLane>(), Ids{"a5"}) << "beside the lane; a6 is farther off";
    EXPECT_EQ(road.asked<traffic::PullAside>(), Ids{}) << "they drive";
    for (const traffic::Lease& lease : road.leases) {
        if (std::holds_alternative<traffic::Stretch>(lease.target)) {
            EXPECT_DOUBLE_EQ(lease.expiry.value, 110.0);
        }
    }
}

TEST(Geocast, asks_slow_vehicles_near_by_to_pull_aside) {
    Broadcast road(three_lanes);
    for (const char* id : {"a2", "a3", "a5"})
        road.scene.set_speed(id, core::MetresPerSecond(2.0));
    policy::GeocastConfig config;
    config.reach_m = 1000.0;
    road.send(config);
    EXPECT_EQ(road.asked<traffic::PullAside>(), Ids{"a2"}) << "a3 is too far, a5 not on the lane";
    EXPECT_TRUE(road.asked<traffic::ChangeLane>().contains("a3"));
    config.aside_m = 0.0;
    road.send(config);
    EXPECT_EQ(road.asked<traffic::PullAside>(), Ids{});
}

TEST(Geocast, clears_the_lane_that_it_is_told_to) {
    Broadcast road(three_lanes);
    policy::GeocastConfig config;
    config.lane = policy::ClearedLane::own;
    road.send(config);
    EXPECT_EQ(road.asked<traffic::ChangeLane>(), Ids{"a5"});
    EXPECT_EQ(road.asked<traffic::HoldLane>(), (Ids{"a2", "a6"})) << "both lanes beside";
    config.lane = policy::ClearedLane::right;
    road.send(config);
    EXPECT_EQ(road.asked<traffic::ChangeLane>(), (Ids{"a6", "e1"}));
}

TEST(Geocast, asks_human_drivers_where_it_is_told_to) {
    Broadcast road(three_lanes);
    policy::GeocastConfig config;
    config.ask_humans = 1;
    road.send(config);
    EXPECT_EQ(road.asked<traffic::ChangeLane>(), (Ids{"a2", "e1", "h1"}));
}

TEST(Geocast, sends_at_its_interval) {
    Broadcast road(three_lanes);
    policy::GeocastConfig config;
    config.interval_s = 2.0;
    int messages = 0;
    for (int decision = 0; decision < 40; ++decision) {
        road.send(config, 100.0 + 0.5 * decision);
        messages += road.asked<traffic::HoldLane>().empty() ? 0 : 1;
        EXPECT_TRUE(road.asked<traffic::ChangeLane>().contains("e1")) << "its own way needs no message";
    }
    EXPECT_EQ(messages, 10);
}

}  // namespace
}  // namespace clearway::testing
