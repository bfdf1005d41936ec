#include "roads/map_matching.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "crossing_network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

constexpr double north_rad = std::numbers::pi / 2.0;

class MapMatchingTest : public ::testing::Test {
  protected:
    std::vector<core::EdgeIndex> route(const std::vector<std::string>& ids) const {
        std::vector<core::EdgeIndex> edges;
        for (const std::string& id : ids)
            edges.push_back(*network_.find_edge(id));
        return edges;
    }
    /// Lane, place and place in the route of a sighting with an error of 1 m.
    std::string match(Point point, double heading_rad, const std::vector<std::string>& ids = {}) {
        const auto way = route(ids);
        const auto place = matcher_.match({point, heading_rad, 1.0, 0.0}, way);
        if (!place) return "nothing";
        return fmt::format("{} {:.1f} {}", network_.lane(place->lane).id, place->position_m,
                           place->route_edge);
    }

    support::TemporaryFolder folder_;
    Network network_ = Network::read(folder_.write("crossing.net.xml", crossing_network()));
    MapMatcher matcher_{network_};
};

TEST_F(MapMatchingTest, TheGridFindsWhatASearchOfAllLanesFinds) {
    const LaneGrid grid(network_);
    std::mt19937 draw(1);
    std::uniform_real_distribution<float> x_m(-20.0F, 330.0F);
    std::uniform_real_distribution<float> y_m(-70.0F, 80.0F);
    std::vector<LanePlace> places;
    std::size_t found = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const Point point{x_m(draw), y_m(draw)};
        constexpr double reach_m = 25.0;
        grid.near(point, core::Metres(reach_m), places);
        std::map<std::uint32_t, LanePlace> by_lane;
        for (const LanePlace& place : places)
            EXPECT_TRUE(by_lane.emplace(place.lane.value, place).second) << "each lane once";
        found += by_lane.size();
        for (std::uint32_t row = 0; row < network_.lanes().size(); ++row) {
            const core::LaneIndex lane{row};
            double nearest_m = 1e9;
            for (double at_m = 0.0; at_m <= network_.lane(lane).length_m; at_m += 0.05) {
                const Point on = network_.point_at(lane, core::Metres(at_m));
                nearest_m = std::min<double>(nearest_m, std::hypot(on.x_m - point.x_m, on.y_m - point.y_m));
            }
            if (std::abs(nearest_m - reach_m) < 0.1) continue;
            const bool is_road = network_.lane(lane).id != "path_0";
            ASSERT_EQ(by_lane.contains(row), is_road && nearest_m < reach_m) << network_.lane(lane).id;
            if (!by_lane.contains(row)) continue;
            const LanePlace& place = by_lane.at(row);
            EXPECT_NEAR(place.distance_m, nearest_m, 0.06);
            const Point on = network_.point_at(lane, core::Metres(place.position_m));
            EXPECT_NEAR(std::hypot(on.x_m - point.x_m, on.y_m - point.y_m), nearest_m, 0.06);
        }
    }
    EXPECT_GT(found, 300u);
}

TEST_F(MapMatchingTest, TakesTheNearestLaneInTheDirectionOfTravel) {
    EXPECT_EQ(match({40.0F, -4.5F}, 0.1), "west_0 40.0 0");
    EXPECT_EQ(match({40.0F, -2.0F}, -0.1), "west_1 40.0 0");
    EXPECT_EQ(match({40.0F, -2.0F}, std::numbers::pi), "nothing");
    EXPECT_EQ(match({105.0F, -40.0F}, north_rad), "south_0 20.0 0");
    EXPECT_EQ(match({105.0F, -40.0F}, -north_rad), "nothing") << "only a footpath leads south";
    EXPECT_EQ(match({40.0F, 40.0F}, 0.0), "nothing");
}

TEST_F(MapMatchingTest, StretchesPlacesToTheStatedLengthOfALane) {
    // 300 m of lane on 310 m of shape.
    EXPECT_EQ(match({155.0F, 60.0F}, std::numbers::pi), "back_0 150.0 0");
}

TEST_F(MapMatchingTest, PrefersTheRouteHoweverNearOtherLanesAre) {
    // 2 m into the junction, where the ways to the north and to the east part.
    EXPECT_EQ(match({105.2F, -8.0F}, north_rad, {"south", "north"}), ":J_3_0 2.0 0");
    EXPECT_EQ(match({105.2F, -8.0F}, 1.05, {"south", "east"}).substr(0, 6), ":J_2_0");
    EXPECT_EQ(match({108.5F, -4.8F}, 0.0), ":J_0_0 8.5 0");
    EXPECT_EQ(match({108.5F, -4.8F}, 0.0, {"south", "east"}), "east_0 0.0 1");
    EXPECT_EQ(match({140.0F, -4.8F}, 0.0, {"west", "east", "back"}), "east_0 30.0 1");
}

TEST_F(MapMatchingTest, TakesAnotherRoadOnlyWhenTheRouteIsOutOfReach) {
    EXPECT_EQ(match({40.0F, -4.8F}, 0.0, {"south", "north"}), "west_0 40.0 0");
    EXPECT_EQ(match({101.0F, -4.8F}, 0.0, {"back"}), "west_0 100.0 0") << "no way through the junction";
}

TEST_F(MapMatchingTest, CountsAnEdgeThatTheRoutePassesTwiceAsItsFirstPassage) {
    EXPECT_EQ(match({140.0F, -4.8F}, 0.0, {"west", "east", "back", "west", "east"}), "east_0 30.0 1");
}

}  // namespace
}  // namespace clearway::roads
