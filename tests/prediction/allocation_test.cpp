// A report must not allocate once buffers have grown.
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
    for (const std::string& name : predictor_names()) {
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

}  // namespace
}  // namespace clearway::prediction
