#include "graph/proximity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <gmock/gmock.h>

#include "reference.hpp"

namespace clearway::graph {
namespace {

using ::testing::ElementsAre;
using traffic::VehicleClass;

constexpr VehicleClass human = VehicleClass::human;
constexpr VehicleClass automated = VehicleClass::automated;
constexpr VehicleClass emergency = VehicleClass::emergency;

ProximityGraph build(const Crowd& crowd, const LinkRules& rules = {},
                     ProximityBuilder::Kernel kernel = ProximityBuilder::Kernel::fastest_here) {
    ProximityBuilder builder(kernel);
    ProximityGraph graph;
    builder.build(crowd.places(), rules, graph);
    return graph;
}

TEST(LinkRules, AllowEveryPairOfDifferentClassesAndOthersOnRequest) {
    LinkRules rules;
    for (const VehicleClass left : traffic::vehicle_classes) {
        for (const VehicleClass right : traffic::vehicle_classes) {
            EXPECT_EQ(rules.allows(left, right), left != right);
        }
    }
    rules.automated_automated = LinkRules::Pairs::included;
    EXPECT_TRUE(rules.allows(automated, automated));
    EXPECT_FALSE(rules.allows(emergency, emergency));
    rules.emergency_emergency = LinkRules::Pairs::included;
    EXPECT_TRUE(rules.allows(emergency, emergency));
    EXPECT_FALSE(rules.allows(human, human));
}

TEST(ProximityGraph, OfNobodyAndOfOneHasNoLinks) {
    Crowd crowd;
    EXPECT_THAT(build(crowd).first, ElementsAre(0u));
    EXPECT_EQ(build(crowd).vehicle_count(), 0u);
    crowd.add(3.0F, 4.0F, emergency);
    EXPECT_THAT(build(crowd).first, ElementsAre(0u, 0u));
    EXPECT_EQ(build(crowd).link_count(), 0u);
}

TEST(ProximityGraph, LinksBothWaysWithEuclideanDistance) {
    Crowd crowd;
    crowd.add(0.0F, 0.0F, automated);
    crowd.add(30.0F, 40.0F - 0.5F, human);
    crowd.add(-3.0F, -4.0F, emergency);
    const ProximityGraph graph = build(crowd);
    EXPECT_THAT(graph.first, ElementsAre(0u, 2u, 3u, 4u));
    EXPECT_THAT(graph.neighbour, ElementsAre(1u, 2u, 0u, 0u));
    EXPECT_NEAR(graph.distance_m[0], std::hypot(30.0, 39.5), 1e-5);
    EXPECT_EQ(graph.distance_m[1], 5.0F);
    EXPECT_EQ(graph.distances_of(2)[0], 5.0F);
    EXPECT_EQ(graph.link_count(), 2u);
}

TEST(ProximityGraph, ADistanceOfExactlyTheRadiusIsNoLink) {
    for (const float radius_m : {50.0F, 0.1F, 33.3F, 1000.0F}) {
        LinkRules rules;
        rules.radius_m = radius_m;
        Crowd at_radius;
        at_radius.add(0.0F, 0.0F, automated);
        at_radius.add(radius_m, 0.0F, human);
        EXPECT_EQ(build(at_radius, rules).link_count(), 0u) << radius_m;
        EXPECT_EQ(build(at_radius, rules, ProximityBuilder::Kernel::scalar).link_count(), 0u) << radius_m;
        at_radius.x_m[1] = std::nextafter(radius_m, 0.0F);
        EXPECT_EQ(build(at_radius, rules).link_count(), 1u) << radius_m;
    }
    Crowd diagonal;
    diagonal.add(0.0F, 0.0F, automated);
    diagonal.add(30.0F, -40.0F, human);
    EXPECT_EQ(build(diagonal).link_count(), 0u);
    LinkRules rules;
    rules.radius_m = 40.0;
    diagonal.x_m[1] = std::nextafter(32.0F, 0.0F);
    diagonal.y_m[1] = 24.0F;
    EXPECT_EQ(build(diagonal, rules).link_count(), 0u)
        << "the square is below 1600 m2, its root rounds to 40 m";
}

TEST(ProximityGraph, VehiclesOnOneSpotAreLinked) {
    Crowd crowd;
    for (int count = 0; count < 20; ++count) {
        crowd.add(7.0F, 7.0F, count % 2 == 0 ? automated : human);
    }
    EXPECT_EQ(build(crowd).link_count(), 100u);
}

TEST(ProximityGraph, AllPairsIgnoreClasses) {
    Crowd crowd;
    crowd.add(0.0F, 0.0F, human);
    crowd.add(10.0F, 0.0F, human);
    crowd.add(20.0F, 0.0F, human);
    ProximityBuilder builder;
    ProximityGraph graph;
    builder.build_all_pairs(crowd.places(), 15.0, graph);
    EXPECT_THAT(graph.neighbour, ElementsAre(1u, 0u, 2u, 1u));
}

TEST(ProximityGraph, RefusesWhatIsNoPlace) {
    Crowd crowd;
    crowd.add(0.0F, 0.0F, human);
    crowd.add(1.0F, 0.0F, automated);
    ProximityBuilder builder;
    ProximityGraph graph;
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Crowd wrong = crowd;
        wrong.y_m[1] = bad;
        EXPECT_THROW(builder.build(wrong.places(), {}, graph), std::invalid_argument);
    }
    Crowd alone;
    alone.add(0.0F, 0.0F, human);
    for (const double radius_m : {0.0, -1.0, 1070.5, std::nan("")}) {
        EXPECT_THROW(builder.build_all_pairs(alone.places(), radius_m, graph), std::invalid_argument)
            << radius_m;
    }
    EXPECT_NO_THROW(builder.build_all_pairs(crowd.places(), 1070.0, graph)) << "the largest";
    for (const auto column : {&Crowd::x_m, &Crowd::y_m}) {
        Crowd longer = crowd;
        (longer.*column).push_back(2.0F);
        EXPECT_THROW(builder.build(longer.places(), {}, graph), std::invalid_argument);
        Crowd wide = crowd;
        (wide.*column) = {-1e11F, 1e11F};
        EXPECT_THROW(builder.build(wide.places(), {}, graph), std::invalid_argument)
            << "more cells than numbers";
    }
}

TEST(ProximityGraph, APairJustInsideTheRadiusIsLinkedWhereverTheCellsBegin) {
    LinkRules rules;
    rules.radius_m = 1000.0;
    Crowd crowd;
    crowd.add(0.0F, 0.0F, human);  // where the first cell begins
    crowd.add(999.9989F, 0.0F, human);
    crowd.add(1999.9983F, 0.0F, automated);  // two cells of 999.999 m on
    const ProximityGraph graph = build(crowd, rules);
    EXPECT_THAT(graph.neighbour, ElementsAre(2u, 1u));
}

TEST(ProximityGraph, AFarOutlierCostsNeitherTimeNorLinks) {
    Crowd crowd;
    for (int vehicle = 0; vehicle < 1000; ++vehicle) {
        crowd.add(static_cast<float>(vehicle), 0.0F, vehicle % 3 == 0 ? automated : human);
    }
    const std::size_t links = build(crowd).link_count();
    crowd.add(1e8F, -1e8F, emergency);
    const ProximityGraph graph = build(crowd);
    EXPECT_EQ(graph.link_count(), links);
    EXPECT_TRUE(graph.neighbours_of(1000).empty());
}

}  // namespace
}  // namespace clearway::graph
