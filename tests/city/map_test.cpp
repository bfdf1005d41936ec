// Maps in: what becomes of an OpenStreetMap extract.
#include <regex>

#include <gmock/gmock.h>

#include "roads/geography.hpp"
#include "roads/network.hpp"
#include "scenario/prepare.hpp"
#include "town.hpp"

namespace clearway::city {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class MapImport : public ImportTest {};

/// 40 streets in two directions; at two corners the streets have one name and become one edge.
constexpr std::size_t town_edges = 76;

TEST_F(MapImport, makes_a_scenario_that_loads_with_sites_signals_and_a_level) {
    const Findings findings = run(request({write("town.osm", town_map())}));
    EXPECT_EQ(findings.car_edges, town_edges);
    EXPECT_EQ(findings.signals, 1U);
    EXPECT_DOUBLE_EQ(findings.connected_share, 1.0);
    EXPECT_FALSE(findings.left_hand);
    EXPECT_THAT(findings.sites, ElementsAre(Pair("fire_station", 1), Pair("hospital", 1)));
    EXPECT_THAT(findings.demand, AllOf(HasSubstr("synthetic"), HasSubstr("on the road")));
    EXPECT_GT(findings.vehicles_per_hour, 0.0);
    for (const char* const file : {"scenario.toml", "network.net.xml", "network.svg", "import.json"})
        EXPECT_TRUE(std::filesystem::exists(out() / "town" / file)) << file;

    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    EXPECT_EQ(config.name, "town");
    EXPECT_EQ(config.emergency_sites.at(0).name, "St. \"Anna\" <Klinik>");
    const scenario::BuiltNetwork network = scenario::build_network(config, folder() / "built");
    const scenario::Prepared prepared =
        scenario::prepare(config, network, core::StudySeed{1}, core::Replication{3}, folder() / "demand");
    ASSERT_EQ(prepared.emergency.size(), 6U);
    for (const traffic::EmergencyDeparture& departure : prepared.emergency) {
        const bool at_site = std::ranges::any_of(config.emergency_sites, [&](const auto& site) {
            return site.edge == departure.edges.front() || site.edge == departure.edges.back();
        });
        EXPECT_TRUE(at_site) << departure.id;
    }
}

TEST_F(MapImport, pedestrians_bring_sidewalks_and_crossings_and_walk_at_the_signal) {
    ImportRequest asked = request({write("town.osm", town_map(13.0, 51.0, "residential"))});
    asked.pedestrians_per_hour = 60.0;
    const Findings findings = run(asked);
    EXPECT_EQ(findings.car_edges, town_edges);
    EXPECT_THAT(findings.changes,
                testing::Contains(HasSubstr("60 pedestrians an hour at each of 4 crossings")));
    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    EXPECT_EQ(config.pedestrians.per_hour, 60.0);
    const scenario::BuiltNetwork network = scenario::build_network(config, folder() / "built");
    const scenario::Prepared prepared =
        scenario::prepare(config, network, core::StudySeed{1}, core::Replication{0}, folder() / "demand");
    EXPECT_EQ(prepared.route_files.size(), 2U);
}

TEST_F(MapImport, pedestrians_in_a_network_without_crossings_are_refused) {
    run(request({write("town.osm", town_map())}, "plain"));
    std::filesystem::rename(out() / "plain" / "network.net.xml", folder() / "plain.net.xml");
    std::filesystem::remove_all(out() / "plain");
    ImportRequest asked = request({folder() / "plain.net.xml"});
    asked.pedestrians_per_hour = 60.0;
    EXPECT_THAT(refusal(asked), HasSubstr("no crossing for pedestrians"));
    EXPECT_FALSE(std::filesystem::exists(out() / "town"));
}

TEST_F(MapImport, packed_maps_give_the_same_scenario) {
    const auto plain = write("town.osm", town_map());
    for (const std::string packing : {"gz", "bz2", "pbf"}) {
        const auto packed = folder() / ("town.osm." + packing);
        run_tool("osmium", {"cat", plain.string(), "-o", packed.string()});
        EXPECT_EQ(run(request({packed}, packing)).car_edges, town_edges) << packing;
    }
    run(request({plain}, "plain"));
    EXPECT_EQ(core::read_file(out() / "plain" / "network.net.xml"),
              core::read_file(out() / "gz" / "network.net.xml"));
}

TEST_F(MapImport, traffic_drives_on_the_left_where_the_country_does_or_as_asked) {
    const auto leeds = write("leeds.osm", town_map(-1.55, 53.8));
    const auto pune = write("pune.osm", town_map(73.85, 18.5));
    const auto boston = write("boston.osm", town_map(-71.06, 42.36));
    EXPECT_TRUE(run(request({leeds}, "leeds")).left_hand);
    EXPECT_TRUE(run(request({pune}, "pune")).left_hand);
    EXPECT_FALSE(run(request({boston}, "boston")).left_hand);
    ImportRequest asked = request({leeds}, "asked");
    asked.side = DrivingSide::right;
    EXPECT_FALSE(run(asked).left_hand);
}

TEST_F(MapImport, nodes_of_the_map_lie_where_the_projection_says) {
    run(request({write("town.osm", town_map(-71.06, 42.36))}));
    const roads::Network network = roads::Network::read(out() / "town" / "network.net.xml");
    const auto geography = roads::Geography::of(network.location());
    ASSERT_TRUE(geography);
    // netconvert's own projection (PROJ) put the junction of node 13 there.
    const std::string text = core::read_file(out() / "town" / "network.net.xml");
    std::smatch junction;
    ASSERT_TRUE(std::regex_search(
        text, junction, std::regex("<junction id=\"13\" type=\"[a-z_]*\" x=\"([0-9.]+)\" y=\"([0-9.]+)\"")));
    const roads::Point point = geography->point({-71.056, 42.364});
    EXPECT_NEAR(point.x_m, std::stod(junction[1]), 0.02);
    EXPECT_NEAR(point.y_m, std::stod(junction[2]), 0.02);
    const roads::Coordinates back = geography->coordinates(point.x_m, point.y_m);
    EXPECT_NEAR(back.longitude_deg, -71.056, 1e-6);
    EXPECT_NEAR(back.latitude_deg, 42.364, 1e-6);
}

TEST_F(MapImport, paths_with_blanks_umlauts_quotes_and_brackets_work) {
    const auto map = write("Müller's Straße/<Karte> \"1\".osm", town_map());
    const Findings findings = run(request({map}, "Größe 'x' <ö> \"y\""));
    EXPECT_EQ(findings.car_edges, town_edges);
    const scenario::ScenarioConfig config = scenario::load((out() / findings.name).string());
    EXPECT_EQ(config.name, "Größe 'x' <ö> \"y\"");
    EXPECT_THAT(core::read_file(out() / findings.name / "network.svg"), HasSubstr("&lt;ö&gt;"));
}

TEST_F(MapImport, equal_maps_give_equal_bytes) {
    const auto map = write("town.osm", town_map());
    run(request({map}, "a/town"));
    run(request({map}, "b/town"));
    for (const char* const file : {"scenario.toml", "network.net.xml", "import.json"})
        EXPECT_EQ(core::read_file(out() / "a/town" / file), core::read_file(out() / "b/town" / file)) << file;
}

TEST_F(MapImport, a_cancelled_import_leaves_nothing) {
    const ImportRequest made = request({write("town.osm", town_map())});
    struct Cancelled {};
    EXPECT_THROW(import(made,
                        [](const std::string& stage, double) {
                            if (stage == "building the network") throw Cancelled{};
                        }),
                 Cancelled);
    EXPECT_TRUE(std::filesystem::is_empty(out()));
}

}  // namespace
}  // namespace clearway::city
