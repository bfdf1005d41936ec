#include "loop/road_layout.hpp"

#include <gmock/gmock.h>

#include "roads/crossing_network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::loop {
namespace {

using testing::ElementsAre;

class RoadLayout : public testing::Test {
  protected:
    const support::TemporaryFolder folder_;
    const roads::Network network_ =
        roads::Network::read(folder_.write("crossing.net.xml", roads::crossing_network()));

    traffic::EmergencyDeparture departure(std::vector<std::string> edges) const {
        traffic::EmergencyDeparture result;
        result.id = "ev";
        result.edges = std::move(edges);
        return result;
    }
};

TEST_F(RoadLayout, TakesEdgesThatEndAtASignalForApproaches) {
    const metrics::RoadLayout layout = road_layout(network_, {});
    ASSERT_EQ(layout.approaches.size(), 2U);
    EXPECT_EQ(layout.approaches[0].edge, "west");
    EXPECT_EQ(layout.approaches[1].edge, "south");
    EXPECT_EQ(layout.approach_of_lane[network_.find_lane("west_1")->value], 0);
    EXPECT_EQ(layout.approach_of_lane[network_.find_lane("south_0")->value], 1);
    EXPECT_EQ(layout.approach_of_lane[network_.find_lane("east_0")->value], metrics::RoadLayout::no_approach);
    EXPECT_EQ(layout.internal_lane[network_.find_lane(":J_2_0")->value], 1);
    EXPECT_EQ(layout.limit_of_lane_mps[network_.find_lane("north_0")->value], 5.0F);
}

TEST_F(RoadLayout, MeasuresTheRouteOfAnEmergencyVehicle) {
    const std::vector departures = {departure({"south", "north"})};
    const metrics::RoadLayout layout = road_layout(network_, departures);
    const metrics::WatchedRoute& route = layout.routes.at(0);
    EXPECT_THAT(route.edge_start_m, ElementsAre(0.0, 60.0)) << "50 m and a way of two pieces, 4 m and 6 m";
    EXPECT_THAT(route.edge_length_m, ElementsAre(50.0, 60.0));
    EXPECT_THAT(route.approach, ElementsAre(1, metrics::RoadLayout::no_approach));
    ASSERT_EQ(route.signals.size(), 1U);
    EXPECT_EQ(route.signals[0].id, "J");
    EXPECT_THAT(route.signals[0].links, ElementsAre(3));
    EXPECT_EQ(route.signals[0].distance_m, 50.0);
    EXPECT_EQ(route.signals[0].approach, 1);
}

TEST_F(RoadLayout, MeasuresTheWayThatAnEmergencyVehicleTakesInstead) {
    const std::vector departures = {departure({"west", "east"})};
    const metrics::RoadLayout layout = road_layout(network_, departures);
    const std::vector way = {*network_.find_edge("south"), *network_.find_edge("north")};
    const metrics::WatchedRoute taken = layout.on_way(layout, layout.routes.at(0), way);
    EXPECT_EQ(taken.vehicle, layout.routes[0].vehicle);
    EXPECT_THAT(taken.edges, ElementsAre("south", "north"));
    EXPECT_THAT(taken.edge_start_m, ElementsAre(0.0, 60.0));
    ASSERT_EQ(taken.signals.size(), 1U);
    EXPECT_EQ(taken.signals[0].distance_m, 50.0);
}

TEST_F(RoadLayout, SaysWhenAnEmergencyVehicleCouldBeAtASignal) {
    std::vector departures = {departure({"south", "north"})};
    departures[0].depart = core::Seconds(100.0);
    const metrics::RoadLayout layout = road_layout(network_, departures);
    const double limit_mps = network_.lane(*network_.find_lane("south_0")).speed_limit_mps;
    EXPECT_DOUBLE_EQ(layout.routes.at(0).signals.at(0).earliest_s, 100.0 + 50.0 / limit_mps);
}

TEST_F(RoadLayout, NumbersTheLinksOfASignalForItsEventLog) {
    const metrics::RoadLayout layout = road_layout(network_, {});
    ASSERT_EQ(layout.signal_heads.size(), 1U);
    const roads::Signal& signal = network_.signal(core::SignalIndex{0});
    ASSERT_EQ(layout.signal_heads[0].size(), signal.links.size());
    const metrics::SignalHead& south = layout.signal_heads[0][3];
    EXPECT_EQ(south.approach, 2U) << "the west comes first";
    for (std::uint16_t other = 0; other < signal.links.size(); ++other)
        EXPECT_EQ(std::ranges::count(south.foes, other), signal.foes[3][other] ? 1 : 0);
}

TEST_F(RoadLayout, KnowsTheWaysOfASignalByTheirInnerLanesAndBothEnds) {
    const metrics::RoadLayout layout = road_layout(network_, {});
    EXPECT_TRUE(std::ranges::is_sorted(layout.signal_ways, {}, &metrics::SignalWay::to));
    for (std::uint32_t lane = 0; lane < network_.lanes().size(); ++lane) {
        for (const roads::Connection& way : network_.connections_from(core::LaneIndex{lane})) {
            if (!way.signal.exists()) continue;
            const auto is_its = [&](core::LaneIndex to, core::LaneIndex from) {
                return std::ranges::any_of(layout.signal_ways, [&](const metrics::SignalWay& one) {
                    return one.to == to && one.from == from && one.link == way.signal_link;
                });
            };
            EXPECT_TRUE(is_its(way.to, way.from));
            EXPECT_TRUE(is_its(way.via, core::LaneIndex::none()));
        }
    }
    EXPECT_FALSE(layout.signal_ways.empty());
}

TEST_F(RoadLayout, StopsWhereARouteNamesNoEdge) {
    const std::vector departures = {departure({"west", "nowhere", "east"})};
    EXPECT_EQ(road_layout(network_, departures).routes.at(0).edge_start_m.size(), 1U);
}

}  // namespace
}  // namespace clearway::loop
