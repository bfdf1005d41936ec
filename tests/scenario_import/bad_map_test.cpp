// Files that cannot be imported: each gets a clear message and leaves nothing behind.
#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <zlib.h>

#include "town.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class BadMap : public ImportTest {
  protected:
    std::string refused(const std::string& name, const std::string& content) const {
        return refusal(request({write(name, content)}));
    }
};

TEST_F(BadMap, missing_and_empty_files) {
    EXPECT_THAT(refusal(request({folder() / "nowhere.osm"})), HasSubstr("does not exist"));
    const auto pipe = folder() / "pipe.osm";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(refusal(request({pipe})), HasSubstr("is neither a file nor a folder"));
    EXPECT_THAT(refused("empty.osm", ""), HasSubstr("is empty"));
    std::filesystem::create_directory(folder() / "maps");
    EXPECT_THAT(refusal(request({folder() / "maps"})), HasSubstr("maps: is a folder"));
    for (const char* const name : {"b.osm.gz", "a.sumocfg", "readme.txt"})
        std::ofstream(folder() / "maps" / name) << "x";
    EXPECT_THAT(refusal(request({folder() / "maps"})),
                HasSubstr("Give one of its files: a.sumocfg, b.osm.gz"));
}

TEST_F(BadMap, plain_xml_of_netconvert) {
    for (const char* const root : {"nodes", "edges", "connections", "types"})
        EXPECT_THAT(refused("plain.xml", fmt::format("<{}/>", root)),
                    AllOf(HasSubstr(fmt::format("is plain XML (<{}>)", root)),
                          HasSubstr("netconvert --node-files X.nod.xml --edge-files X.edg.xml")));
}

TEST_F(BadMap, an_empty_map) {
    EXPECT_THAT(refused("empty.osm", "<osm version='0.6'/>"), HasSubstr("is a map without roads"));
}

TEST_F(BadMap, a_map_without_nodes) {
    const std::string map = town_map();
    const std::size_t nodes = map.find("<node");
    EXPECT_THAT(refused("ways.osm", map.substr(0, nodes) + map.substr(map.find("<way"))),
                AllOf(HasSubstr("not their nodes"), HasSubstr("out body; >; out skel qt;")));
}

TEST_F(BadMap, a_merge_names_the_map_that_is_cut_short) {
    const std::string map = town_map();
    EXPECT_THAT(refusal(request({write("whole.osm", map), write("cut.osm", map.substr(0, map.size() / 2))})),
                AllOf(HasSubstr("/cut.osm: cannot be read"), Not(HasSubstr("map-"))));
}

TEST_F(BadMap, roads_too_short_for_any_trip) {
    std::string map = "<osm version='0.6'>";
    for (int id = 1; id <= 16; ++id)
        map += fmt::format("<node id='{}' version='1' lat='{:.5f}' lon='{:.5f}'/>", id,
                           51.0 + id / 4 * 0.0001, 13.0 + id % 4 * 0.00015);
    for (int id = 1; id <= 16; ++id)
        for (const int to : {id + 1, id + 4})
            if (to <= 16 && (to == id + 4 || to % 4 != 0))
                map += fmt::format(
                    "<way id='{}' version='1'><nd ref='{}'/><nd ref='{}'/><tag k='highway' "
                    "v='residential'/><tag k='name' v='{}'/></way>",
                    100 * id + to, id, to, 100 * id + to);
    EXPECT_THAT(refused("short.osm", map + "</osm>"),
                AllOf(HasSubstr("short.osm: has no road of 20 m"), HasSubstr("larger extract"),
                      Not(HasSubstr("minimum_edge_m"))));
}

TEST_F(BadMap, pedestrians_on_a_map_without_a_place_for_crossings) {
    std::string map = town_map(13.0, 51.0, "primary");
    for (std::size_t at = map.find("<tag k='name' v='Straße"); at != std::string::npos;
         at = map.find("<tag k='name' v='Straße", at + 60))
        map.insert(at, "<tag k='maxspeed' v='100'/>");
    ImportRequest asked = request({write("fast.osm", map)});
    asked.pedestrians_per_hour = 60.0;
    EXPECT_THAT(refusal(asked), AllOf(HasSubstr("netconvert finds no place for a crossing"),
                                      Not(HasSubstr("let netconvert guess"))));
}

TEST_F(BadMap, a_map_without_roads_for_cars) {
    EXPECT_THAT(refused("paths.osm", town_map(13.0, 51.0, "footway")), HasSubstr("no road for cars"));
    const std::filesystem::path ring = "/usr/share/sumo/tools/game/racing/spreewaldring.osm";
    ASSERT_TRUE(std::filesystem::exists(ring)) << "package sumo-tools is in packaging/packages.txt";
    EXPECT_THAT(refusal(request({ring})), AllOf(HasSubstr(ring.string()), HasSubstr("no road for cars")));
}

TEST_F(BadMap, web_pages_json_and_archives) {
    EXPECT_THAT(refused("map.osm", "<!DOCTYPE html><html><body>429 Too Many Requests</body></html>"),
                AllOf(HasSubstr("is a web page (HTML)"), HasSubstr("download")));
    EXPECT_THAT(refused("map.osm", "{\"elements\": []}"), HasSubstr("is JSON"));
    EXPECT_THAT(refused("map.osm", "PK\x03\x04 and more"), HasSubstr("is a zip archive"));
    EXPECT_THAT(refused("map.osm", "just words"), HasSubstr("neither XML nor a map"));
    EXPECT_THAT(refused("map.osm", "<gpx version='1.1'/>"), HasSubstr("root element <gpx>"));
}

TEST_F(BadMap, a_truncated_pbf) {
    const auto whole = folder() / "town.osm.pbf";
    run_tool("osmium", {"cat", write("town.osm", town_map()).string(), "-o", whole.string()});
    const std::string bytes = core::read_file(whole);
    EXPECT_THAT(refused("cut.osm.pbf", bytes.substr(0, bytes.size() * 3 / 4)),
                AllOf(HasSubstr("cut.osm.pbf"), HasSubstr("cannot be read as a map")));
}

TEST_F(BadMap, a_truncated_map) {
    const std::string map = town_map();
    EXPECT_THAT(refused("cut.osm", map.substr(0, map.size() / 2)), HasSubstr("cannot be read as a map"));
}

TEST_F(BadMap, a_bomb) {
    const auto bomb = folder() / "bomb.osm.gz";
    gzFile stream = gzopen(bomb.c_str(), "wb9");
    ASSERT_NE(stream, nullptr);
    const std::string blanks(std::size_t{1} << 20, ' ');
    gzputs(stream, "<osm version='0.6'>");
    for (int megabyte = 0; megabyte < 120; ++megabyte)
        gzwrite(stream, blanks.data(), static_cast<unsigned>(blanks.size()));
    gzclose(stream);
    EXPECT_THAT(refusal(request({bomb})), HasSubstr("unpacks to more than 250 times"));
}

TEST_F(BadMap, a_name_that_is_taken_or_none) {
    const auto map = write("town.osm", town_map());
    for (const char* const name : {".hidden", "a,b", "line\nbreak", "Köln Süd", "a\"b"})
        EXPECT_THAT(refusal(request({map}, name)), HasSubstr("cannot be the name of a folder"));
    std::filesystem::create_directories(out() / "town");
    EXPECT_THROW(run(request({map})), core::InputError);
    EXPECT_TRUE(std::filesystem::is_empty(out() / "town"));
}

TEST_F(BadMap, a_name_that_another_import_took_in_the_meantime) {
    const ImportRequest made = request({write("town.osm", town_map())});
    const auto taken = [&](const std::string& stage, double) {
        if (stage != "done") return;
        std::filesystem::create_directories(made.folder);
        core::write_atomically(made.folder / "scenario.toml", "");
    };
    try {
        import(made, taken);
        ADD_FAILURE() << "was imported";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("in the meantime"));
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out()), {}), 1);
}

TEST_F(BadMap, a_folder_with_a_comma_in_its_path) {
    EXPECT_THAT(
        refusal(request({write("town.osm", town_map())}, "a,b/town")),
        AllOf(HasSubstr("a,b/town: would lie in a folder with a comma"), Not(HasSubstr("importing"))));
}

TEST_F(BadMap, a_network_of_an_unknown_version) {
    std::string text = core::read_file(line_network());
    const std::size_t at = text.find("<net version=\"");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string("<net version=\"").size(), "<net version=\"7");
    EXPECT_THAT(refused("new.net.xml", text), HasSubstr("unknown version \"7"));
}

TEST_F(BadMap, a_network_with_lanes_out_of_order_is_named_as_given) {
    std::string text = core::read_file(line_network());
    const std::string lane = "<lane id=\"first_1\" index=\"1\"";
    const std::size_t at = text.find(lane);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, lane.size(), "<lane id=\"first_1\" index=\"0\"");
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    EXPECT_THAT(
        refused("mine.net.xml", text),
        AllOf(HasSubstr(fmt::format("{}:{}: index=\"0\"", (folder() / "mine.net.xml").string(), line)),
              HasSubstr("netconvert --sumo-net-file"), Not(HasSubstr("importing"))));
}

TEST_F(BadMap, a_network_that_bears_no_level_of_demand) {
    run_tool("netgenerate",
             {"--grid", "--grid.number", "3", "--grid.length", "200", "--default-junction-type",
              "traffic_light", "-o", (folder() / "grid.net.xml").string()});
    std::string text = core::read_file(folder() / "grid.net.xml");
    for (std::size_t at = text.find("<phase "); at != std::string::npos; at = text.find("<phase ", at)) {
        at = text.find("state=\"", at) + 7;
        std::fill(text.begin() + static_cast<std::ptrdiff_t>(at),
                  text.begin() + static_cast<std::ptrdiff_t>(text.find('"', at)), 'r');
    }
    EXPECT_THAT(refused("red.net.xml", text),
                AllOf(HasSubstr("red.net.xml: cannot carry any level of demand: of "),
                      HasSubstr("SUMO teleports them"), HasSubstr("sumo-gui")));
}

TEST_F(BadMap, a_network_without_roads_for_cars) {
    EXPECT_THAT(refused("empty.net.xml",
                        "<net version=\"1.9\"><location netOffset=\"0,0\" "
                        "convBoundary=\"0,0,1,1\" origBoundary=\"0,0,1,1\" "
                        "projParameter=\"!\"/></net>"),
                HasSubstr("no road for cars"));
}

}  // namespace
}  // namespace clearway::scenario_import
