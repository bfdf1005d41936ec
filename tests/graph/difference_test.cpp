#include "graph/difference.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

#include "reference.hpp"

namespace clearway::graph {
namespace {

using core::VehicleKey;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using traffic::VehicleClass;

/// Vehicles on a line, 50 m radius.
struct Line {
    std::vector<VehicleKey> keys;
    ProximityGraph graph;

    Line(std::vector<std::pair<std::uint64_t, float>> places) {
        Crowd crowd;
        for (const auto& [key, x_m] : places) {
            keys.push_back({key});
            crowd.add(x_m, 0.0F, VehicleClass::human);
        }
        ProximityBuilder().build_all_pairs(crowd.places(), 50.0, graph);
    }
    KeyedGraph view() const { return {graph, keys}; }
};

LinkKeys link(std::uint64_t low, std::uint64_t high) {
    return {{low}, {high}};
}

TEST(GraphDifference, OfAGraphAndItselfInOtherRowsIsNothing) {
    const Line one({{1, 0.0F}, {2, 40.0F}, {3, 80.0F}});
    const Line other({{3, 80.0F}, {1, 0.0F}, {2, 40.0F}});
    const Difference same = difference(one.view(), other.view());
    EXPECT_THAT(same.lost, IsEmpty());
    EXPECT_THAT(same.added, IsEmpty());
    EXPECT_EQ(same.kept, 2u);
}

TEST(GraphDifference, NamesLostAndAddedLinksByKey) {
    const Line before({{1, 0.0F}, {2, 40.0F}, {3, 80.0F}});
    const Line after({{1, 0.0F}, {3, 30.0F}, {2, 75.0F}});
    const Difference changed = difference(before.view(), after.view());
    EXPECT_THAT(changed.lost, ElementsAre(link(1, 2)));
    EXPECT_THAT(changed.added, ElementsAre(link(1, 3)));
    EXPECT_EQ(changed.kept, 1u);
    const Difference back = difference(after.view(), before.view());
    EXPECT_EQ(back.lost, changed.added);
    EXPECT_EQ(back.added, changed.lost);
}

TEST(GraphDifference, VehiclesOfOneGraphAloneLoseOrAddTheirLinks) {
    const Line before({{7, 0.0F}, {9, 10.0F}});
    const Line after({{9, 10.0F}, {4, 12.0F}});
    const Difference changed = difference(before.view(), after.view());
    EXPECT_THAT(changed.lost, ElementsAre(link(7, 9)));
    EXPECT_THAT(changed.added, ElementsAre(link(4, 9)));
    EXPECT_EQ(changed.kept, 0u);
    EXPECT_EQ(difference(Line({}).view(), after.view()).added.size(), 1u);
}

TEST(GraphDifference, RefusesKeysThatDoNotFit) {
    const Line line({{1, 0.0F}, {2, 40.0F}});
    EXPECT_THROW(difference({line.graph, {}}, line.view()), std::invalid_argument);
}

}  // namespace
}  // namespace clearway::graph
