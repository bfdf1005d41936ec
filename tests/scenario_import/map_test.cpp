// Maps in: what becomes of an OpenStreetMap extract.
#include <regex>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <zlib.h>

#include "roads/geography.hpp"
#include "roads/network.hpp"
#include "scenario/prepare.hpp"
#include "scenario_import/osm/driving_side.hpp"
#include "scenario_import/osm/map_contents.hpp"
#include "town.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class MapImport : public ImportTest {
  protected:
    /// A map with its ways before its nodes, as Overpass writes it for some queries.
    static std::string ways_first(const std::string& map) {
        const std::size_t nodes = map.find("<node");
        const std::size_t ways = map.find("<way");
        const std::size_t end = map.rfind("</osm>");
        return map.substr(0, nodes) + map.substr(ways, end - ways) + map.substr(nodes, ways - nodes) +
               "</osm>\n";
    }
};

/// 40 streets in two directions; at two corners the streets have one name and become one edge.
constexpr std::size_t town_edges = 76;

TEST_F(MapImport, a_wide_map_of_slow_roads_has_a_horizon_by_which_its_trips_arrive) {
    const Findings findings = run(request({write("wide.osm", town_map(13.0, 51.0, "living_street", 0.01))}));
    EXPECT_THAT(findings.demand, HasSubstr("all have arrived after"));
    EXPECT_GT(scenario::load((out() / "town").string()).time.horizon_s, 3600.0);
}

TEST_F(MapImport, makes_a_scenario_that_loads_with_sites_signals_and_a_level) {
    const Findings findings = run(request({write("town.osm", town_map())}));
    EXPECT_EQ(findings.car_edges, town_edges);
    EXPECT_EQ(findings.signals, 1U);
    EXPECT_DOUBLE_EQ(findings.connected_share, 1.0);
    EXPECT_FALSE(findings.left_hand);
    EXPECT_THAT(findings.sites, ElementsAre(Pair("fire_station", 1), Pair("hospital", 1)));
    EXPECT_THAT(findings.demand, AllOf(HasSubstr("synthetic"), HasSubstr("on the road")));
    EXPECT_GT(findings.vehicles_per_hour, 0.0);
    EXPECT_THAT(to_text(findings), HasSubstr("1 fire station, 1 hospital (St. \"Anna\" <Klinik>; unnamed,"));
    EXPECT_THAT(to_text(findings), HasSubstr("([[emergency_site]])"));
    EXPECT_THAT(to_text(findings),
                HasSubstr("  map data         of unknown age: its objects have no timestamps\n"));
    EXPECT_THAT(to_text(findings),
                testing::ContainsRegex("demand           [0-9]+ vehicles, [0-9]+ an hour: "));
    EXPECT_THAT(findings.emergency_trips,
                HasSubstr("half from fire stations (no ambulance station is known) to"));
    EXPECT_THAT(findings.changes, Contains(testing::EndsWith("SUMO's types for towns, 50 km/h")))
        << "it has no motorway";
    for (const char* const file :
         {"scenario.toml", "network.net.xml", "network.svg", "import.json", "preemption.csv"})
        EXPECT_TRUE(std::filesystem::exists(out() / "town" / file)) << file;

    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    EXPECT_EQ(config.name, "town");
    EXPECT_EQ(config.emergency_sites.at(0).name, "St. \"Anna\" <Klinik>");
    const scenario::BuiltNetwork network = scenario::build_network(config, folder() / "built");
    ASSERT_EQ(network.preemption.size(), 1U) << "filled from the network";
    EXPECT_EQ(network.preemption.front().enabled, 1);
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

TEST_F(MapImport, accounts_for_every_signal_of_the_map) {
    std::string map = town_map();
    const std::string between =
        "<node id='200' version='1' lat='51.0' lon='13.001'>"
        "<tag k='highway' v='traffic_signals'/></node>\n";
    map.insert(map.find("<node id='100'"), between);
    const Findings findings = run(request({write("town.osm", map)}));
    EXPECT_EQ(findings.signals, 1U);
    EXPECT_EQ(findings.map_signals, 1U);
    EXPECT_THAT(findings.left_out,
                ElementsAre(AllOf(testing::StartsWith("1 signals of the map between junctions"),
                                  HasSubstr("(Straße 0)"))));
    EXPECT_THAT(to_text(findings), HasSubstr("1 (from 1 node of the map"));
}

TEST_F(MapImport, pedestrians_bring_sidewalks_and_crossings_and_walk_at_the_signal) {
    ImportRequest asked = request({write("town.osm", town_map(13.0, 51.0, "residential"))});
    asked.pedestrians_per_hour = 60.0;
    const Findings findings = run(asked);
    EXPECT_EQ(findings.car_edges, town_edges);
    EXPECT_THAT(findings.changes,
                testing::Contains(HasSubstr("60 pedestrians per hour at each of 4 crossings")));
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

/// netconvert ignores the version; osmium does not.
TEST_F(MapImport, a_map_of_no_or_another_version_gives_the_same_network) {
    const std::string map = town_map();
    const std::string root = "<osm version='0.6'>";
    const auto with_root = [&](const std::string& other) {
        return std::string(map).replace(map.find(root), root.size(), other);
    };
    const auto network_of = [&](const std::string& name, const std::filesystem::path& file) {
        EXPECT_EQ(run(request({file}, name)).car_edges, town_edges) << name;
        const std::string text = core::read_file(out() / name / "network.net.xml");
        return text.substr(text.find("<edge "));
    };
    const std::string expected = network_of("plain", write("plain.osm", map));
    EXPECT_EQ(network_of("none", write("none.osm", with_root("<osm>"))), expected);
    EXPECT_EQ(network_of("old", write("old.osm", with_root("<osm generator='x' version=\"0.5\">"))),
              expected);
    const auto packed = folder() / "none.osm.gz";
    gzFile stream = gzopen(packed.c_str(), "wb");
    const std::string unversioned = with_root("<osm>");
    gzwrite(stream, unversioned.data(), static_cast<unsigned>(unversioned.size()));
    gzclose(stream);
    EXPECT_EQ(network_of("packed", packed), expected);
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

TEST_F(MapImport, a_town_on_the_antimeridian_lies_where_it_lies) {
    std::string map = town_map(179.996, -17.0);
    for (std::size_t at = map.find("lon='180."); at != std::string::npos; at = map.find("lon='180.")) {
        const std::size_t end = map.find('\'', at + 5);
        const double longitude = std::stod(map.substr(at + 5, end - at - 5)) - 360.0;
        map.replace(at + 5, end - at - 5, fmt::format("{:.6f}", longitude));
    }
    const detail::MapContents contents = detail::read_map(write("taveuni.osm", map));
    EXPECT_NEAR(std::abs(contents.centre.longitude_deg), 180.0, 0.01);
    EXPECT_NEAR(contents.car_roads_km, 10 * (0.25 * 4 * 0.8886), 0.2);
    EXPECT_FALSE(detail::left_driving_land(contents.centre).empty());
}

TEST_F(MapImport, roads_with_a_side_of_their_own_do_not_turn_the_map_and_that_is_said) {
    std::string map = town_map();
    const std::string street = "<tag k='name' v='Straße 1'/>";
    map.replace(map.find(street), street.size(), "<tag k='driving_side' v='left'/>");
    const Findings findings = run(request({write("town.osm", map)}));
    EXPECT_FALSE(findings.left_hand);
    EXPECT_THAT(findings.side_reason, HasSubstr("1 of 10 roads are tagged otherwise"));
    EXPECT_THAT(to_text(findings), HasSubstr("on the right, as in most countries"));
}

TEST_F(MapImport, main_roads_without_a_limit_get_that_of_towns_and_that_is_said) {
    const auto map = write("town.osm", town_map(13.0, 51.0, "primary"));
    const Findings findings = run(request({map}));
    const double map_km = detail::read_map(map).car_roads_km;
    EXPECT_THAT(
        findings.changes,
        testing::Contains(HasSubstr(fmt::format(
            "of the map's {:.1f} km of road, both directions together, have no speed limit", map_km))));
    EXPECT_LT(findings.road_km, 2.0 * map_km) << "each direction, without junctions";
    EXPECT_GT(findings.road_km, 1.6 * map_km);
    EXPECT_THAT(to_text(findings), HasSubstr(fmt::format("roads for cars   {:.1f} km by direction, without "
                                                         "junctions; ",
                                                         findings.road_km)));
    const roads::Network network = roads::Network::read(out() / "town" / "network.net.xml");
    for (const roads::Edge& edge : network.edges()) {
        if (edge.internal) continue;
        EXPECT_NEAR(network.lane(core::LaneIndex{edge.first_lane}).speed_limit_mps, 13.89, 0.01);
    }
}

TEST_F(MapImport, says_how_old_the_data_is) {
    std::string map = town_map();
    const auto stamp = [&](const std::string& element, const char* day) {
        map.insert(map.find(element) + element.size(), fmt::format(" timestamp='{}T14:50:31Z'", day));
    };
    stamp("<node", "2009-12-31");
    stamp("<way", "2012-05-03");
    const Findings newest = run(request({write("town.osm", map)}));
    EXPECT_EQ(newest.map_date, "2012-05-03 (newest object)");
    EXPECT_THAT(to_text(newest), HasSubstr("of 2012-05-03 (newest object): "));
    EXPECT_THAT(to_text(newest), HasSubstr(" years old,"));
    EXPECT_EQ(scenario::load((out() / "town").string()).network.map_date, "2012-05-03 (newest object)");
    EXPECT_THAT(core::read_file(out() / "town" / "import.json"), HasSubstr("\"map_date\": \"2012-05-03 (n"));

    const std::size_t head = map.find('>', map.find("<osm")) + 1;
    map.insert(head, "<meta osm_base=\"2023-11-05T10:00:00Z\"/>");
    EXPECT_EQ(run(request({write("stated.osm", map)}, "stated")).map_date, "2023-11-05") << "of Overpass";
}

TEST_F(MapImport, names_the_limits_of_those_classes_that_have_none) {
    std::string map = town_map(13.0, 51.0, "living_street");
    const Findings slow = run(request({write("slow.osm", map)}, "slow"));
    EXPECT_THAT(slow.changes, Contains(testing::EndsWith("for towns, 10 km/h in living streets")));
    map.replace(map.find("living_street"), 13, "motorway");
    const Findings fast = run(request({write("fast.osm", map)}, "fast"));
    EXPECT_THAT(fast.changes,
                Contains(testing::EndsWith("for towns, 100 km/h on motorways, 10 km/h in living streets")));
    map.replace(map.find("living_street"), 13, "primary");
    const Findings all = run(request({write("all.osm", map)}, "all"));
    EXPECT_THAT(all.changes,
                Contains(testing::EndsWith("10 km/h in living streets, 50 km/h on other roads")));
}

TEST_F(MapImport, limits_of_the_map_stay) {
    std::string map = town_map(13.0, 51.0, "primary");
    for (std::size_t at = map.find("<tag k='name' v='Straße"); at != std::string::npos;
         at = map.find("<tag k='name' v='Straße", at + 60))
        map.insert(at, "<tag k='maxspeed' v='100'/>");
    const Findings findings = run(request({write("town.osm", map)}));
    EXPECT_THAT(findings.changes, ElementsAre(HasSubstr("programs of 1 signal are netconvert's")))
        << "no limit";
    const roads::Network network = roads::Network::read(out() / "town" / "network.net.xml");
    for (const roads::Edge& edge : network.edges()) {
        if (edge.internal) continue;
        EXPECT_NEAR(network.lane(core::LaneIndex{edge.first_lane}).speed_limit_mps, 27.78, 0.01);
    }
}

TEST_F(MapImport, ways_before_nodes_give_the_same_network) {
    const std::string sorted = town_map();
    const auto map = write("town.osm", sorted);
    const auto turned = write("turned.osm", ways_first(sorted));
    run(request({map}, "sorted"));
    const Findings findings = run(request({turned}, "turned"));
    EXPECT_THAT(findings.sites, ElementsAre(Pair("fire_station", 1), Pair("hospital", 1)));
    EXPECT_EQ(core::read_file(out() / "sorted" / "network.net.xml"),
              core::read_file(out() / "turned" / "network.net.xml"));
    EXPECT_EQ(run(request({map, turned}, "both")).car_edges, town_edges);
}

/// Ids of OpenStreetMap today. Osmium's sets take 4 MiB for each 33 million of ids that are in use.
TEST_F(MapImport, ids_far_apart_take_no_memory_and_are_kept) {
    std::string map = town_map();
    map.erase(map.rfind("</osm>"));
    std::string refs = "<nd ref='1'/>";
    for (long id = 1; id < 200; ++id) {
        map += fmt::format("<node id='{}' version='1' lat='{:.5f}' lon='13.02'/>", id * 40'000'000L,
                           51.0 + 1e-4 * static_cast<double>(id));
        refs += fmt::format("<nd ref='{}'/>", id * 40'000'000L);
    }
    map += "<way id='12345678901' version='1'>" + refs + "<tag k='highway' v='secondary'/></way></osm>";
    run(request({write("town.osm", map)}));
    const std::string network = core::read_file(out() / "town" / "network.net.xml");
    EXPECT_THAT(network, AllOf(HasSubstr("<edge id=\"12345678901"), HasSubstr("<edge id=\"1000")));
    EXPECT_THAT(network, HasSubstr("<junction id=\"7960000000\""));
    rusage used{};
    ASSERT_EQ(::getrusage(RUSAGE_CHILDREN, &used), 0);
    EXPECT_LT(used.ru_maxrss, 250 * 1024) << "KiB of the largest child process";
}

TEST_F(MapImport, maps_are_read_by_what_they_hold_whatever_their_names) {
    const auto map = write("town.osm", town_map());
    const auto packed = folder() / "town.osm.gz";
    run_tool("osmium", {"cat", map.string(), "-o", packed.string()});
    for (const auto& [from, name] :
         {std::pair{map, "town"}, std::pair{map, "town.txt"}, std::pair{packed, "packed.osm"}}) {
        std::filesystem::copy_file(from, folder() / name);
        EXPECT_EQ(run(request({folder() / name}, name)).car_edges, town_edges) << name;
    }
}

TEST_F(MapImport, what_overpass_could_not_finish_is_named) {
    std::string map = town_map();
    map.insert(map.rfind("</osm>"), "<remark> runtime error: Query timed out after 26 seconds. </remark>");
    EXPECT_THAT(
        run(request({write("town.osm", map)})).left_out,
        testing::Contains(AllOf(HasSubstr("Overpass did not finish"), HasSubstr("timed out after 26"))));
}

TEST_F(MapImport, a_site_at_a_road_that_is_cut_off_is_told_from_one_without_a_road) {
    std::string map = town_map();
    for (const char* const way : {"<way id='2000' version='1'><nd ref='901'/><nd ref='902'/>",
                                  "<way id='2001' version='1'><nd ref='902'/><nd ref='904'/>",
                                  "<way id='2002' version='1'><nd ref='902'/><nd ref='905'/>"})
        map.insert(map.rfind("</osm>"), std::string(way) + "<tag k='highway' v='residential'/></way>");
    map.insert(map.find("<way"),
               "<node id='900' version='1' lat='51.0301' lon='13.0001'><tag k='amenity' v='hospital'/>"
               "<tag k='name' v='Island'/></node><node id='901' version='1' lat='51.03' lon='13.0'/>"
               "<node id='902' version='1' lat='51.03' lon='13.002'/><node id='904' version='1' lat='51.032' "
               "lon='13.002'/><node id='905' version='1' lat='51.03' lon='13.004'/><node id='903' "
               "version='1' lat='51.06' lon='13.0'><tag k='amenity' "
               "v='hospital'/><tag k='name' v='Forest'/></node>");
    const Findings findings = run(request({write("town.osm", map)}));
    EXPECT_THAT(findings.left_out,
                AllOf(testing::Contains(AllOf(HasSubstr("do not lead there"), HasSubstr("Island"))),
                      testing::Contains(AllOf(HasSubstr("away from the roads"), HasSubstr("Forest")))));
}

TEST_F(MapImport, the_speed_that_was_found_counts_those_who_drive) {
    // Four streets of 60 m round a block: mostly nobody is on the road, of whom SUMO says speed -1.
    std::string map = "<osm version='0.6'>";
    const double corners[4][2] = {{0, 0}, {0, 0.0006}, {0.0004, 0.0006}, {0.0004, 0}};
    for (int row = 0; row < 4; ++row)
        map += fmt::format("<node id='{}' version='1' lat='{:.4f}' lon='{:.4f}'/>", row + 1,
                           51.0 + corners[row][0], 13.0 + corners[row][1]);
    for (int row = 0; row < 4; ++row)
        map += fmt::format(
            "<way id='{0}' version='1'><nd ref='{0}'/><nd ref='{1}'/><tag k='highway' "
            "v='residential'/><tag k='name' v='S{0}'/></way>",
            row + 1, (row + 1) % 4 + 1);
    const Findings findings = run(request({write("block.osm", map + "</osm>")}));
    std::smatch speed;
    ASSERT_TRUE(std::regex_search(findings.demand, speed, std::regex("mean speed (-?[0-9]+) %")))
        << findings.demand;
    EXPECT_GT(std::stoi(speed[1]), 20);
    EXPECT_LE(std::stoi(speed[1]), 110);
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
    const Findings findings = run(request({map}, "Größe 'x' <ö> \"y\"/town"));
    EXPECT_EQ(findings.car_edges, town_edges);
    const scenario::ScenarioConfig config = scenario::load((out() / "Größe 'x' <ö> \"y\"/town").string());
    EXPECT_EQ(config.name, "town");
    EXPECT_THAT(core::read_file(config.folder / "network.svg"), HasSubstr("&lt;Karte&gt;"));
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
}  // namespace clearway::scenario_import
