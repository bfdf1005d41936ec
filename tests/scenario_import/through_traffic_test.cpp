// Networks that are driven through, in which few edges reach each other: an intersection alone, a motorway.
#include <map>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "scenario/prepare.hpp"
#include "town.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSubsetOf;
using testing::Not;
using testing::StartsWith;

using Route = std::vector<std::string>;

class ThroughTraffic : public ImportTest {
  protected:
    /// Four arms of 200 m, each with an edge in and one out, round a signal; nobody turns round.
    std::filesystem::path cross_network() const {
        std::string nodes = "<nodes><node id='c' x='0' y='0' type='traffic_light'/>";
        std::string edges = "<edges>";
        const std::vector<std::pair<std::string, std::string>> arms = {
            {"n", "x='0' y='200'"}, {"e", "x='200' y='0'"}, {"s", "x='0' y='-200'"}, {"w", "x='-200' y='0'"}};
        for (const auto& [name, place] : arms) {
            nodes += fmt::format("<node id='{}' {}/>", name, place);
            edges += fmt::format(
                "<edge id='in_{0}' from='{0}' to='c' numLanes='2' speed='13.9'/>"
                "<edge id='out_{0}' from='c' to='{0}' numLanes='2' speed='13.9'/>",
                name);
        }
        const auto node_file = write("cross.nod.xml", nodes + "</nodes>");
        const auto edge_file = write("cross.edg.xml", edges + "</edges>");
        run_tool("netconvert", {"--node-files", node_file.string(), "--edge-files", edge_file.string(),
                                "--no-turnarounds", "--output-file", (folder() / "cross.net.xml").string()});
        return folder() / "cross.net.xml";
    }

    /// A motorway of 4 km in one direction with a way off and a way on, 300 m each; a fire station at its
    /// beginning and a hospital at its end.
    std::filesystem::path motorway_map() const {
        std::string xml = "<osm version='0.6'>";
        const auto node = [&](int id, double east, double north, const char* tags = "") {
            xml += fmt::format("<node id='{}' version='1' lat='{:.6f}' lon='{:.6f}'>{}</node>", id,
                               48.0 + north, 11.0 + east, tags);
        };
        for (int row = 0; row < 5; ++row)
            node(row + 1, row * 0.0134, 0.0);
        node(6, 0.0134 + 0.004, -0.001);
        node(7, 2 * 0.0134 - 0.004, -0.001);
        node(8, 0.001, 0.0005, "<tag k='amenity' v='fire_station'/>");
        node(9, 4 * 0.0134 - 0.001, 0.0005, "<tag k='amenity' v='hospital'/>");
        const auto way = [&](int id, const Route& refs, const char* type) {
            xml += fmt::format("<way id='{}' version='1'>", id);
            for (const std::string& ref : refs)
                xml += fmt::format("<nd ref='{}'/>", ref);
            xml += fmt::format(
                "<tag k='highway' v='{}'/><tag k='oneway' v='yes'/><tag k='maxspeed' v='80'/></way>", type);
        };
        way(1, {"1", "2", "3", "4", "5"}, "motorway");
        way(2, {"2", "6"}, "motorway_link");
        way(3, {"7", "3"}, "motorway_link");
        return write("motorway.osm", xml + "</osm>");
    }

    /// Of the vehicles of the first replication, then of its EVs.
    struct Routes {
        std::vector<Route> traffic, emergency;
    };
    Routes routes() const {
        const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
        const scenario::BuiltNetwork network = scenario::build_network(config, folder() / "built");
        const scenario::Prepared prepared =
            scenario::prepare(config, network, core::StudySeed{1}, core::Replication{0}, folder() / "demand");
        Routes result;
        for (const traffic::EmergencyDeparture& departure : prepared.emergency)
            result.emergency.push_back(departure.edges);
        const std::string text = core::read_file(prepared.route_files.front());
        const std::string mark = " edges=\"";
        for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
            const std::size_t start = at + mark.size();
            std::istringstream words(text.substr(start, text.find('"', start) - start));
            result.traffic.emplace_back(std::istream_iterator<std::string>(words),
                                        std::istream_iterator<std::string>());
        }
        return result;
    }
};

TEST_F(ThroughTraffic, an_intersection_alone_is_driven_through_from_every_arm) {
    const Findings findings = run(request({cross_network()}));
    EXPECT_LT(findings.connected_share, 0.2);
    EXPECT_THAT(findings.changes, Contains(HasSubstr("12.5 % of the car edges reach each other")));
    EXPECT_THAT(findings.demand, HasSubstr("from roads that enter the map"));
    const Routes found = routes();
    ASSERT_GE(found.traffic.size(), 20U);
    ASSERT_EQ(found.emergency.size(), 6U);
    std::set<std::string> origins;
    for (const auto* list : {&found.traffic, &found.emergency})
        for (const Route& route : *list) {
            ASSERT_EQ(route.size(), 2U);
            EXPECT_THAT(route[0], StartsWith("in_"));
            EXPECT_THAT(route[1], StartsWith("out_"));
            origins.insert(route[0]);
        }
    EXPECT_EQ(origins.size(), 4U);
}

TEST_F(ThroughTraffic, a_motorway_is_driven_along_its_ramps_are_used_and_sites_are_reached) {
    const Findings findings = run(request({motorway_map()}));
    EXPECT_THAT(findings.sites,
                AllOf(Contains(testing::Pair("hospital", 1)), Contains(testing::Pair("fire_station", 1))));
    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    EXPECT_EQ(config.trips.ends, scenario::TripEnds::reachable);
    const Routes found = routes();
    std::size_t ramps = 0;
    for (const Route& route : found.traffic) {
        EXPECT_GE(route.size(), 2U);
        const auto is_ramp = [](const std::string& edge) {
            return edge.starts_with("2") || edge.starts_with("3");
        };
        ramps += std::ranges::any_of(route, is_ramp) ? 1U : 0U;
    }
    EXPECT_GT(ramps, found.traffic.size() / 10);
    EXPECT_LT(ramps, found.traffic.size());
    for (const Route& route : found.emergency) {
        EXPECT_GE(route.size(), 2U);
        const bool at_site = std::ranges::any_of(config.emergency_sites, [&](const auto& site) {
            return site.edge == route.front() || site.edge == route.back();
        });
        EXPECT_TRUE(at_site);
    }
}

TEST_F(ThroughTraffic, a_town_in_which_all_edges_reach_each_other_keeps_its_trips) {
    const Findings findings = run(request({write("town.osm", town_map())}));
    EXPECT_THAT(findings.changes, Not(Contains(HasSubstr("reach each other"))));
    EXPECT_THAT(core::read_file(out() / "town" / "scenario.toml"), Not(HasSubstr("reachable")));
}

}  // namespace
}  // namespace clearway::scenario_import
