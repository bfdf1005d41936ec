#include "scenario/site.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "scenario/prepare.hpp"
#include "scenario/prepared_demand.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class SiteTest : public PreparedDemand {
  protected:
    static EmergencySite station_at(double longitude, double latitude) {
        EmergencySite site;
        site.kind = SiteKind::ambulance_station;
        site.longitude = longitude;
        site.latitude = latitude;
        return site;
    }
    /// The city with these sites, in a folder.
    std::string city(const std::vector<EmergencySite>& sites) const {
        ScenarioConfig config = load("city");
        config.emergency_sites = sites;
        config.demand.emergency = 6;
        store(config, folder() / "own");
        return (folder() / "own").string();
    }
};

TEST_F(SiteTest, vehicles_of_a_station_at_coordinates_start_on_the_nearest_road) {
    const std::string name = city({station_at(13.53, 52.431)});
    const Prepared planned = prepared(name);
    std::vector<core::Problem> problems;
    const std::vector<core::EdgeIndex> edges = site_edges(load(name), network(name), problems);
    ASSERT_THAT(problems, SizeIs(0));
    ASSERT_THAT(edges, SizeIs(1));
    EXPECT_TRUE(std::ranges::binary_search(trip_edges(network(name), load(name).trips), edges[0]));

    const std::string& edge = network(name).edge(edges[0]).id;
    ASSERT_THAT(planned.emergency, SizeIs(6));
    for (const traffic::EmergencyDeparture& departure : planned.emergency)
        EXPECT_TRUE(departure.edges.front() == edge || departure.edges.back() == edge) << departure.id;

    EmergencySite by_name = station_at(13.53, 52.431);
    by_name.longitude.reset();
    by_name.latitude.reset();
    by_name.edge = edge;
    EXPECT_EQ(prepared(city({by_name})).demand_hash, planned.demand_hash);
}

TEST_F(SiteTest, no_other_road_of_trips_is_nearer) {
    const std::string name = city({station_at(13.53, 52.431)});
    prepared(name);
    const roads::Network& roads = network(name);
    const std::vector<SiteKind> kinds{SiteKind::ambulance_station};
    const SiteRoads of_sites(roads, load(name).trips, kinds);
    const std::vector<core::EdgeIndex> all = trip_edges(roads, load(name).trips);
    // Beside the middle of a straight road its ends are far away, and it is nearest all the same.
    const auto straight = std::ranges::find_if(all, [&](core::EdgeIndex edge) {
        const roads::Lane& lane = roads.lane(roads.lane_of(edge, 0));
        return lane.shape.size() == 2 && roads.edge(edge).length_m > 150.0F;
    });
    ASSERT_NE(straight, all.end());
    const auto& shape = roads.lane(roads.lane_of(*straight, 0)).shape;
    const roads::Point middle{(shape.front().x_m + shape.back().x_m) / 2,
                              (shape.front().y_m + shape.back().y_m) / 2};
    EXPECT_EQ(of_sites.nearest(SiteKind::ambulance_station, middle), *straight);
    EXPECT_TRUE(of_sites.is_near_road(middle));
    const roads::Point far{static_cast<float>(roads.location().x_maximum_m + 301.0), middle.y_m};
    EXPECT_FALSE(of_sites.nearest(SiteKind::hospital, far).exists());
    EXPECT_FALSE(of_sites.is_near_road(far));
}

TEST_F(SiteTest, coordinates_are_kept_when_a_scenario_is_stored) {
    const ScenarioConfig stored = load(city({station_at(13.53, 52.431)}));
    ASSERT_THAT(stored.emergency_sites, SizeIs(1));
    EXPECT_EQ(stored.emergency_sites[0].longitude, 13.53);
    EXPECT_EQ(stored.emergency_sites[0].latitude, 52.431);
    EXPECT_EQ(stored.emergency_sites[0].edge, "");
}

TEST_F(SiteTest, a_site_has_an_edge_or_both_coordinates) {
    EmergencySite both = station_at(13.53, 52.431);
    both.edge = "e0";
    EmergencySite half = station_at(13.53, 52.431);
    half.latitude.reset();
    const std::string name = city({both, half, EmergencySite{}});
    std::vector<std::string> lines;
    for (const core::Problem& problem : problems_of([&] { load(name); })) {
        EXPECT_THAT(problem.where, HasSubstr("emergency_site["));
        EXPECT_EQ(problem.allowed, "edge, or longitude and latitude");
        lines.push_back(problem.what);
    }
    EXPECT_THAT(lines, ElementsAre("has an edge, and coordinates besides",
                                   "has but one of longitude and latitude", "has no place"));
}

TEST_F(SiteTest, places_off_the_map_are_refused_with_its_range) {
    const std::string name = city({station_at(52.431, 13.53), station_at(13.0, 52.431)});
    const auto problems = problems_of([&] { prepared(name); });
    ASSERT_THAT(problems, SizeIs(2));
    EXPECT_THAT(problems[0].where, HasSubstr("emergency_site[0].longitude"));
    for (const core::Problem& problem : problems) {
        EXPECT_THAT(problem.what, HasSubstr("no road that trips can use within 300 m of "));
        EXPECT_THAT(problem.allowed, AllOf(HasSubstr("longitude 13."), HasSubstr("latitude 52.")));
        EXPECT_THAT(problem.cure, HasSubstr("longitude is east"));
    }
}

TEST_F(SiteTest, coordinates_need_a_network_from_a_map) {
    ScenarioConfig config = load("random_town");
    config.emergency_sites = {station_at(13.53, 52.431)};
    store(config, folder() / "town");
    const auto problems = problems_of([&] { prepared((folder() / "town").string()); });
    ASSERT_THAT(problems, SizeIs(1));
    EXPECT_THAT(problems[0].what, HasSubstr("has no projection"));
    EXPECT_EQ(problems[0].cure, "give edge instead");
}

}  // namespace
}  // namespace clearway::scenario
