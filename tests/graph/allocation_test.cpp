#include <gtest/gtest.h>

#include "core/random.hpp"
#include "reference.hpp"
#include "support/allocation_count.hpp"

namespace clearway::graph {
namespace {

Crowd crowd_at(std::uint64_t step) {
    const core::KeyedRandom random({1}, {0});
    Crowd crowd;
    for (std::uint64_t vehicle = 0; vehicle < 2000; ++vehicle) {
        const auto at = [&](std::uint64_t axis) {
            return static_cast<float>(1500.0 *
                                      random.uniform(core::Purpose::demand, vehicle, 2 * step + axis));
        };
        crowd.add(at(0), at(1), traffic::vehicle_classes[vehicle % 3]);
    }
    return crowd;
}

TEST(ProximityBuilder, AllocatesNothingOnceItsBuffersHaveGrown) {
    ProximityBuilder builder;
    ProximityGraph graph;
    const Crowd first = crowd_at(0);
    builder.build_all_pairs(first.places(), 60.0, graph);  // More links than those below.
    builder.build_all_pairs(first.places(), 60.0, graph);
    for (std::uint64_t step = 1; step < 20; ++step) {
        const Crowd crowd = crowd_at(step);
        const std::size_t before = support::allocation_count();
        builder.build(crowd.places(), {}, graph);
        EXPECT_EQ(support::allocation_count(), before) << step;
        EXPECT_GT(graph.link_count(), 1000u);
    }
    EXPECT_GT(support::allocation_count(), 0u);
}

}  // namespace
}  // namespace clearway::graph
