// A report must not allocate once buffers have grown.
#include <vector>

#include <gtest/gtest.h>

#include "prediction/darkness.hpp"
#include "prediction/predictor.hpp"
#include "support/allocation_count.hpp"

namespace clearway::prediction {
namespace {

TEST(Predictors, DoNotAllocateOnceBuffersHaveGrown) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        a.h.a.hh.a..e.h.a.a.+hh.a..h.e.a.h...|G.......................
        .h.a.ha.e.h..a.h.h.a+.a..h.a.hh.a....|r.......................
    )");
    traffic::Observation observation =
        testing::after_outage(scene, 6.0, {"a1", "a3", "h2", "h5", "e1", "a7", "e2", "h9"});
    observation.detected_links = {{scene.key("a1"), scene.key("h1"), -1.0F, 0.0F}};
    for (const std::string& name : predictors().names()) {
        const auto predictor = make_predictor(name, {scene.network(), {}, "", {}});
        traffic::BelievedGraph belief;
        predictor->predict(observation, belief);
        predictor->predict(observation, belief);
        const std::size_t before = support::allocation_count();
        predictor->predict(observation, belief);
        EXPECT_EQ(support::allocation_count() - before, 0u) << name;
        EXPECT_GT(belief.link_count(), 0u) << name;
    }
    EXPECT_GT(support::allocation_count(), 0u) << "the count must count";
}

/// Time passes between the calls, so twins drive, lay new paths, and vehicles come and go.
TEST(CarFollowing, DoesNotAllocateWhileTimePassesOnceBuffersHaveGrown) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 5 m/s
        a.h.a.hh.a..e.h.a.a.+hh.a..h.e.a.h...|G..............................................
        .h.a.ha.e.h..a.h.h.a+.a..h.a.hh.a....|r..............................................
    )");
    const traffic::Observation first = support::perfect_observation(scene);
    std::vector<traffic::Observation> observations = {first};
    for (int second = 1; second <= 30; ++second) {
        traffic::Observation now = testing::after_outage(scene, 1.0, {});
        for (std::size_t row = 0; row < now.vehicles.size(); ++row) {
            // Each vehicle is heard every tenth second.
            if ((row + static_cast<std::size_t>(second)) % 10 == 0) continue;
            traffic::ObservedVehicle& vehicle = now.vehicles[row];
            vehicle = observations.back().vehicles[row];
            vehicle.freshness = traffic::Freshness::stale;
            vehicle.age_s += 1.0F;
        }
        observations.push_back(std::move(now));
    }
    for (std::size_t at = 0; at < observations.size(); ++at) {
        if (at % 3 == 0) observations[at].vehicles.pop_back();
    }
    const auto predictor = make_predictor("car_following", {scene.network(), {}, "", {}});
    traffic::BelievedGraph belief;
    const auto drive = [&] {
        for (const traffic::Observation& observation : observations)
            predictor->predict(observation, belief);
        return belief.vehicles.front().state.x_m;
    };
    const float there_m = drive();
    EXPECT_NE(there_m, first.vehicles.front().state.x_m) << "it drove";
    drive();
    const std::size_t before = support::allocation_count();
    EXPECT_EQ(drive(), there_m) << "every pass starts anew";
    EXPECT_EQ(support::allocation_count() - before, 0u);
}

}  // namespace
}  // namespace clearway::prediction
