// Files that cannot be imported: each gets a clear message and leaves nothing behind.
#include <gmock/gmock.h>
#include <zlib.h>

#include "town.hpp"

namespace clearway::city {
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
    EXPECT_THAT(refused("empty.osm", ""), HasSubstr("is empty"));
}

TEST_F(BadMap, an_empty_map) {
    EXPECT_THAT(refused("empty.osm", "<osm version='0.6'/>"), HasSubstr("is a map without roads"));
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
    for (const char* const name : {".hidden", "a,b", "line\nbreak"})
        EXPECT_THAT(refusal(request({map}, name)), HasSubstr("is no name for a scenario"));
    std::filesystem::create_directories(out() / "town");
    EXPECT_THROW(run(request({map})), core::InputError);
    EXPECT_TRUE(std::filesystem::is_empty(out() / "town"));
}

TEST_F(BadMap, a_network_of_an_unknown_version) {
    std::string text = core::read_file(line_network());
    const std::size_t at = text.find("<net version=\"");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string("<net version=\"").size(), "<net version=\"7");
    EXPECT_THAT(refused("new.net.xml", text), HasSubstr("unknown version \"7"));
}

TEST_F(BadMap, a_network_without_roads_for_cars) {
    EXPECT_THAT(refused("empty.net.xml",
                        "<net version=\"1.9\"><location netOffset=\"0,0\" "
                        "convBoundary=\"0,0,1,1\" origBoundary=\"0,0,1,1\" "
                        "projParameter=\"!\"/></net>"),
                HasSubstr("no road for cars"));
}

}  // namespace
}  // namespace clearway::city
