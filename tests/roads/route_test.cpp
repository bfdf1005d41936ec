#include "roads/route.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "crossing_network.hpp"
#include "roads/fastest_routes.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

using core::Metres;
using ::testing::ElementsAre;
using traffic::MotionState;

class RouteTest : public ::testing::Test {
  protected:
    core::EdgeIndex edge(const std::string& id) const { return *network_.find_edge(id); }
    std::vector<core::EdgeIndex> route(const std::vector<std::string>& ids) const {
        std::vector<core::EdgeIndex> edges;
        for (const std::string& id : ids) {
            edges.push_back(edge(id));
        }
        return edges;
    }
    MotionState on(const std::string& lane, float position_m, std::uint32_t route_edge = 0) const {
        return {.speed_mps = 7.0F,
                .lane = *network_.find_lane(lane),
                .lane_position_m = position_m,
                .route_edge = route_edge};
    }
    std::string lane_name(const MotionState& state) const { return network_.lane(state.lane).id; }

    support::TemporaryFolder folder_;
    Network network_ = Network::read(folder_.write("crossing.net.xml", crossing_network()));
};

TEST_F(RouteTest, FastestRouteIncludesBothEnds) {
    EXPECT_EQ(FastestRoutes(network_).between(edge("south"), edge("west")),
              route({"south", "east", "back", "west"}));
    EXPECT_EQ(FastestRoutes(network_).between(edge("east"), edge("east")), route({"east"}));
    EXPECT_FALSE(FastestRoutes(network_).between(edge("north"), edge("west")).has_value());
    EXPECT_FALSE(FastestRoutes(network_).between(edge("west"), edge("path")).has_value());
    EXPECT_FALSE(FastestRoutes(network_).between(edge("path"), edge("west")).has_value());
}

TEST_F(RouteTest, LengthIncludesTheWaysAcrossJunctions) {
    EXPECT_NEAR(route_length(network_, route({"west", "east"})).value, 310.0, 1e-4);
    EXPECT_NEAR(route_length(network_, route({"south", "north"})).value, 120.0, 1e-4);
    EXPECT_NEAR(route_length(network_, route({"west", "east", "back"})).value, 610.0, 1e-4);
    EXPECT_EQ(route_length(network_, {}).value, 0.0);
}

TEST_F(RouteTest, AdvanceStaysOnTheLane) {
    const auto way = route({"west", "east"});
    const Advanced near = advance(network_, way, on("west_1", 20.0F), Metres(30.0));
    EXPECT_EQ(lane_name(near.state), "west_1");
    EXPECT_NEAR(near.state.lane_position_m, 50.0, 1e-4);
    EXPECT_NEAR(near.state.x_m, 50.0, 1e-4);
    EXPECT_NEAR(near.state.y_m, -1.6, 1e-4);
    EXPECT_EQ(near.state.speed_mps, 7.0F);
    EXPECT_EQ(near.past_end.value, 0.0);
    const Advanced inside = advance(network_, way, on("west_1", 20.0F), Metres(85.0));
    EXPECT_EQ(lane_name(inside.state), ":J_0_1");
    EXPECT_EQ(inside.state.route_edge, 0u);
    EXPECT_NEAR(inside.state.lane_position_m, 5.0, 1e-4);
    const Advanced beyond = advance(network_, way, on("west_1", 20.0F), Metres(100.0));
    EXPECT_EQ(lane_name(beyond.state), "east_1");
    EXPECT_EQ(beyond.state.route_edge, 1u);
    EXPECT_NEAR(beyond.state.lane_position_m, 10.0, 1e-4);
}

TEST_F(RouteTest, AdvancePassesWaysInSeveralPieces) {
    const auto way = route({"south", "north"});
    const Advanced second_piece = advance(network_, way, on("south_0", 45.0F), Metres(10.0));
    EXPECT_EQ(lane_name(second_piece.state), ":J_4_0");
    EXPECT_NEAR(second_piece.state.lane_position_m, 1.0, 1e-4);
    EXPECT_EQ(second_piece.state.route_edge, 0u);
    const Advanced around = advance(network_, way, second_piece.state, Metres(35.0));
    EXPECT_EQ(lane_name(around.state), "north_0");
    EXPECT_NEAR(around.state.heading_rad, 0.0, 1e-6);
    EXPECT_NEAR(around.state.x_m, 115.0, 1e-4);
}

TEST_F(RouteTest, AdvanceTakesTheNearestLaneThatContinues) {
    // Only east_1 leads back.
    const Advanced moved =
        advance(network_, route({"east", "back", "west"}), on("east_0", 150.0F), Metres(60.0));
    EXPECT_EQ(lane_name(moved.state), "back_0");
    EXPECT_NEAR(moved.state.lane_position_m, 10.0, 1e-4);
}

TEST_F(RouteTest, AdvanceStopsAtTheEndAndTellsTheOvershoot) {
    const auto way = route({"west", "east"});
    const Advanced past = advance(network_, way, on("west_0", 0.0F), Metres(330.0));
    EXPECT_EQ(lane_name(past.state), "east_0");
    EXPECT_NEAR(past.state.lane_position_m, 200.0, 1e-4);
    EXPECT_NEAR(past.past_end.value, 20.0, 1e-4);
    // North does not lead west: the route ends where it breaks.
    const Advanced broken = advance(network_, route({"north", "west"}), on("north_0", 50.0F), Metres(30.0));
    EXPECT_EQ(lane_name(broken.state), "north_0");
    EXPECT_NEAR(broken.past_end.value, 20.0, 1e-4);
}

TEST_F(RouteTest, AdvanceByNothingChangesNothing) {
    MotionState state = on("west_0", 20.0F);
    state.y_m = -3.9F;
    EXPECT_EQ(advance(network_, route({"west"}), state, Metres(0.0)).state.y_m, -3.9F);
}

TEST_F(RouteTest, AdvanceInPiecesEqualsAdvanceAtOnce) {
    const auto way = route({"south", "east", "back", "west"});
    for (const double step_m : {0.7, 3.0, 11.0}) {
        MotionState state = on("south_0", 0.0F);
        int steps = 0;
        for (; steps * step_m < 500.0; ++steps) {
            state = advance(network_, way, state, Metres(step_m)).state;
        }
        const MotionState at_once = advance(network_, way, on("south_0", 0.0F), Metres(steps * step_m)).state;
        EXPECT_EQ(lane_name(state), lane_name(at_once));
        EXPECT_NEAR(state.lane_position_m, at_once.lane_position_m, 0.01) << step_m;
    }
}

TEST_F(RouteTest, DistanceToEndAgreesWithAdvance) {
    const auto way = route({"south", "east", "back"});
    const MotionState start = on("south_0", 12.0F);
    const Metres left = distance_to_end(network_, way, start);
    EXPECT_NEAR(left.value, 38.0 + 10.0 + 200.0 + 300.0, 1e-4);
    const Advanced end = advance(network_, way, start, left);
    EXPECT_NEAR(end.past_end.value, 0.0, 1e-4);
    EXPECT_NEAR(end.state.lane_position_m, 300.0, 1e-3);
    EXPECT_NEAR(distance_to_end(network_, way, on(":J_2_0", 4.0F)).value, 506.0, 1e-4);
}

TEST_F(RouteTest, DistanceAheadSeesOtherLanesJunctionsAndEdges) {
    const auto way = route({"south", "north"});
    const MotionState start = on("south_0", 20.0F);
    const auto ahead = [&](const MotionState& other, double horizon_m = 1000.0) {
        return distance_ahead(network_, way, start, other, Metres(horizon_m));
    };
    EXPECT_NEAR(ahead(on("south_0", 35.0F))->value, 15.0, 1e-4);
    EXPECT_EQ(ahead(on("south_0", 20.0F))->value, 0.0);
    EXPECT_FALSE(ahead(on("south_0", 19.0F)).has_value());
    EXPECT_NEAR(ahead(on(":J_3_0", 1.0F))->value, 31.0, 1e-4);
    EXPECT_NEAR(ahead(on(":J_4_0", 1.0F))->value, 35.0, 1e-4);
    EXPECT_NEAR(ahead(on("north_0", 2.0F, 1))->value, 42.0, 1e-4);
    EXPECT_FALSE(ahead(on("north_0", 2.0F, 1), 41.0).has_value());
    EXPECT_FALSE(ahead(on(":J_2_0", 1.0F)).has_value());
    EXPECT_FALSE(ahead(on("west_0", 90.0F)).has_value());
    EXPECT_FALSE(ahead(MotionState{}).has_value());
    // Another lane of the same edge counts.
    EXPECT_NEAR(distance_ahead(network_, route({"west", "east"}), on("west_0", 10.0F), on("east_1", 5.0F),
                               Metres(500.0))
                    ->value,
                105.0, 1e-4);
    EXPECT_NEAR(distance_ahead(network_, route({"west", "east"}), on(":J_0_0", 2.0F), on(":J_0_1", 5.0F),
                               Metres(500.0))
                    ->value,
                3.0, 1e-4);
}

TEST_F(RouteTest, DistanceAheadOnARoundTripFindsWhoIsBehindOnTheSameEdge) {
    const auto way = route({"west", "east", "back", "west"});
    EXPECT_NEAR(
        distance_ahead(network_, way, on("west_0", 50.0F), on("west_0", 40.0F), Metres(1000.0))->value,
        50.0 + 10.0 + 200.0 + 300.0 + 40.0, 1e-3);
}

TEST_F(RouteTest, SignalsAheadAreThoseOnTheRouteWithinTheHorizon) {
    const auto way = route({"west", "east", "back", "west", "east"});
    const auto lines = signals_ahead(network_, way, on("west_0", 30.0F), Metres(2000.0));
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0].signal, *network_.find_signal("J"));
    EXPECT_EQ(lines[0].edge, edge("west"));
    EXPECT_EQ(lines[0].next_edge, edge("east"));
    EXPECT_THAT(lines[0].links, ElementsAre(0, 1));
    EXPECT_NEAR(lines[0].distance.value, 70.0, 1e-4);
    EXPECT_NEAR(lines[1].distance.value, 70.0 + 10.0 + 200.0 + 300.0 + 100.0, 1e-3);
    EXPECT_EQ(signals_ahead(network_, way, on("west_0", 30.0F), Metres(69.0)).size(), 0u);
    EXPECT_THAT(
        signals_ahead(network_, route({"south", "north"}), on("south_0", 0.0F), Metres(100.0))[0].links,
        ElementsAre(3));
    // Inside the junction its signal is behind.
    EXPECT_EQ(signals_ahead(network_, route({"west", "east"}), on(":J_0_0", 1.0F), Metres(500.0)).size(), 0u);
}

TEST_F(RouteTest, DrivableEndsWhereALaneDoesNotContinue) {
    const auto way = route({"west", "east", "back"});
    const auto from = [&](const char* lane, double position_m, double horizon_m) {
        return drivable(network_, way, 0, *network_.find_lane(lane), Metres(position_m), Metres(horizon_m))
            .value;
    };
    EXPECT_NEAR(from("west_0", 40.0, 5000.0), 60.0 + 10.0 + 200.0, 1e-4);
    EXPECT_NEAR(from("west_1", 40.0, 5000.0), 60.0 + 10.0 + 200.0 + 300.0, 1e-4);
    EXPECT_NEAR(from("west_1", 40.0, 100.0), 100.0, 1e-4);
    EXPECT_NEAR(from("west_1", 150.0, 100.0), 100.0, 1e-4);
}

TEST_F(RouteTest, RefusesStatesOutsideLaneOrRoute) {
    const auto way = route({"west", "east"});
    EXPECT_THROW(advance(network_, way, MotionState{}, Metres(1.0)), std::invalid_argument);
    EXPECT_THROW(advance(network_, way, on("west_0", 1.0F, 2), Metres(1.0)), std::invalid_argument);
    EXPECT_THROW(advance(network_, way, on("west_0", 1.0F), Metres(-1.0)), std::invalid_argument);
    EXPECT_THROW(advance(network_, way, on("west_0", 1.0F), Metres(std::nan(""))), std::invalid_argument);
    EXPECT_THROW(distance_to_end(network_, {}, on("west_0", 1.0F)), std::invalid_argument);
}

}  // namespace
}  // namespace clearway::roads
