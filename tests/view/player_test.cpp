#include "view/player.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "support/crossing_scene.hpp"
#include "view/drawing.hpp"
#include "view/frame.hpp"
#include "view/recorded_run.hpp"

namespace clearway::view {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

PlayList list_with(const std::string& title) {
    const std::string about = nlohmann::json{{"run", title}, {"condition", title}}.dump();
    return {.drawings = {"{}"},
            .plays = {{.title = title,
                       .note = title,
                       .drawing = 0,
                       .runs = {{about, "stream", 0.0, 1.0}},
                       .followed = title}}};
}

TEST(Player, no_name_becomes_markup) {
    const std::string title = "</script><script>alert(1)</script><!--";
    const std::string page = player_page(title, list_with(title));
    EXPECT_THAT(page, Not(HasSubstr("alert(1)</script>")));
    EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;"));
    EXPECT_THAT(page, HasSubstr("\\u003c/script>"));
}

TEST(Player, a_page_allows_its_own_script_and_nothing_from_elsewhere) {
    const std::string page = player_page("city", list_with("city"));
    EXPECT_THAT(page, HasSubstr("content=\"default-src 'none'; script-src 'sha256-"));
    EXPECT_THAT(page, Not(HasSubstr("connect-src")));
    EXPECT_THAT(page, Not(HasSubstr("unsafe-eval")));
    EXPECT_THAT(page, Not(HasSubstr(" src=")));
    EXPECT_THAT(live_page("city"), HasSubstr("connect-src 'self'"));
}

TEST(Player, the_script_may_stand_in_a_page_and_is_less_than_a_megabyte) {
    const std::string script = core::read_file(CLEARWAY_SOURCE_DIR "/page/dist/player.js");
    EXPECT_THAT(script, Not(HasSubstr("</script")));
    EXPECT_THAT(script, Not(HasSubstr("<!--")));
    EXPECT_LT(script.size(), 1'000'000U);
    EXPECT_THAT(player_markup({}), HasSubstr(script));
}

TEST(Player, bytes_are_packed_as_zlib_and_base64) {
    // Made with Python: base64.b64encode(zlib.compress(b"Clearway " * 3, 9)).
    EXPECT_EQ(packed("Clearway Clearway Clearway "), "eNpzzklNLCpPrFRwxmAAAI2QCgk=");
}

TEST(About, says_which_lanes_are_blocked_where_and_when) {
    const roads::Network& network = testing::two_crossings();
    const core::EdgeIndex edge = network.lane(network.signals().front().links.front().front().from).edge;
    traffic::Incident incident;
    incident.edge = edge;
    incident.lanes = {0};
    incident.position_m = 10.0F;
    incident.from = core::Seconds(80.0);
    incident.to = core::Seconds(320.0);
    const auto about =
        nlohmann::json::parse(view::about({"town", "navigate", 3}, {}, network, {&incident, 1}));
    EXPECT_EQ(about.at("replication"), 3);
    ASSERT_EQ(about.at("incidents").size(), 1U);
    const auto& told = about["incidents"][0];
    EXPECT_EQ(told.at("edge"), edge.value);
    EXPECT_EQ(told.at("lanes"), nlohmann::json({network.lane_of(edge, 0).value}));
    EXPECT_EQ(told.at("from_s"), 80.0);
    EXPECT_EQ(told.at("to_s"), 320.0);
    const Origin origin = origin_of(network);
    const roads::Lane& lane = network.lane(network.lane_of(edge, 0));
    const roads::Point begin = lane.shape.front();
    const double away_m = std::hypot(told["place"][0].get<double>() - origin.x(begin.x_m),
                                     told["place"][1].get<double>() - origin.y(begin.y_m)) *
                          quantum_m;
    EXPECT_NEAR(away_m, 10.0, 0.2);
}

TEST(Drawing, holds_every_lane_and_stop_line_of_the_network) {
    const roads::Network& network = testing::two_crossings();
    const auto drawing = nlohmann::json::parse(drawing_of(network));
    ASSERT_EQ(drawing.at("lanes").size(), network.lanes().size());
    ASSERT_EQ(drawing.at("edges").size(), 2 * network.edges().size());
    EXPECT_EQ(drawing["edges"][2], network.edges()[1].first_lane);
    EXPECT_EQ(drawing["edges"][3], network.edges()[1].lane_count);
    const Origin origin = origin_of(network);
    const roads::Lane& lane = network.lanes().front();
    EXPECT_EQ(drawing["lanes"][0]["shape"].size(), 2 * lane.shape.size());
    EXPECT_EQ(drawing["lanes"][0]["shape"][0], origin.x(lane.shape.front().x_m));
    ASSERT_EQ(drawing.at("signals").size(), network.signals().size());
    const roads::Signal& signal = network.signals().front();
    EXPECT_EQ(drawing["signals"][0]["links"].size(), signal.links.size());
    const roads::Point end = network.lane(signal.links.front().front().from).shape.back();
    EXPECT_EQ(drawing["signals"][0]["links"][0][0][0], origin.x(end.x_m));
    EXPECT_EQ(drawing["signals"][0]["links"][0][0][1], origin.y(end.y_m));
}

}  // namespace
}  // namespace clearway::view
