#include "scenario/signal_sheet.hpp"

#include <gmock/gmock.h>

#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/temporary_folder.hpp"
#include "scenario/picture.hpp"

namespace clearway::scenario {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

roads::Network sheet_crossings() {
    return roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
}

TEST(SignalSheet, says_what_the_program_of_a_signal_shows) {
    std::vector<traffic::Preemption> set(2);
    set[0].dwell_s = 7.0;
    const auto sheets = signal_sheets(sheet_crossings(), set);
    ASSERT_EQ(sheets.size(), 2U);
    const SignalSheet& sheet = sheets.front();
    EXPECT_EQ(sheet.signal, "A");
    EXPECT_EQ(sheet.controller, "static");
    EXPECT_TRUE(sheet.coordinated);
    EXPECT_DOUBLE_EQ(sheet.cycle_s, 90.0);
    ASSERT_TRUE(sheet.yellow.has_value());
    EXPECT_DOUBLE_EQ(sheet.yellow->shortest_s, 4.0);
    EXPECT_FALSE(sheet.red_clearance.has_value()) << "the next green follows the yellow";
    EXPECT_FALSE(sheet.least_green.has_value());
    EXPECT_NEAR(sheet.place.x_m, 500.0, 1.0);
    EXPECT_NEAR(sheet.place.y_m, 300.0, 1.0);
    EXPECT_EQ(sheet.set.dwell_s, 7.0);
    EXPECT_EQ(sheets.back().set, traffic::Preemption{});
}

TEST(SignalSheet, names_the_approaches_of_each_phase) {
    const auto sheets = signal_sheets(sheet_crossings(), {});
    const SignalSheet& sheet = sheets.front();
    ASSERT_EQ(sheet.approaches.size(), 4U);
    EXPECT_EQ(sheet.approaches[0].edge, "north_a_A");
    EXPECT_THAT(sheet.approaches[0].links, ElementsAre(0, 1, 2, 3));
    ASSERT_EQ(sheet.phases.size(), 4U);
    EXPECT_TRUE(sheet.phases[0].green);
    EXPECT_FALSE(sheet.phases[1].green);
    EXPECT_THAT(sheet.phases[0].edges, ElementsAre("north_a_A", "south_a_A"));
    EXPECT_THAT(sheet.phases[2].edges, ElementsAre("B_A", "west_A"));
    EXPECT_TRUE(sheet.phases[1].edges.empty());
}

TEST(SignalSheet, of_a_signal_with_a_crossing_counts_it_apart) {
    const auto sheets =
        signal_sheets(roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/footway.net.xml"), {});
    EXPECT_EQ(sheets.front().crossings, 1U);
    EXPECT_FALSE(sheets.front().phases.at(0).on_foot);
    EXPECT_TRUE(sheets.front().phases.at(2).on_foot);
    ASSERT_TRUE(sheets.front().yellow.has_value());
    EXPECT_DOUBLE_EQ(sheets.front().yellow->longest_s, 3.0);
}

TEST(SignalsPicture, has_a_number_and_a_name_at_each_signal) {
    const roads::Network network = sheet_crossings();
    const std::string svg = signals_picture(network, "two <crossings>", "Map (c) A & B");
    EXPECT_THAT(svg, HasSubstr("two &lt;crossings&gt;"));
    EXPECT_THAT(svg, HasSubstr("Map (c) A &amp; B</text>"));
    EXPECT_THAT(svg, HasSubstr(">#1</text>"));
    EXPECT_THAT(svg, HasSubstr(">#2</text>"));
    EXPECT_THAT(svg, ::testing::AllOf(HasSubstr("cx=\"210.0\""), HasSubstr("cx=\"750.0\"")))
        << "300 m apart and 100 m from the sides, which 900 units show; the roads are longer";
    EXPECT_THAT(svg, HasSubstr("<title>#1: A</title>"));
    EXPECT_THAT(network_picture(network, "two", ""), ::testing::Not(HasSubstr(">#1</text>")));
}

TEST(SignalsPicture, names_a_signal_by_its_streets_as_equip_does) {
    std::string text = core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    const auto name = [&](const std::string& edge, const std::string& street) {
        const std::string begin = "<edge id=\"" + edge + "\"";
        text.replace(text.find(begin), begin.size(), begin + " name=\"" + street + "\"");
    };
    for (const char* const edge : {"A_B", "B_A", "west_A", "east_B"})
        name(edge, "Main Road");
    name("north_a_A", "Side Street");
    const core::TemporaryFolder folder;
    core::write_output(folder.path() / "net.net.xml", text);
    const std::string svg = signals_picture(roads::Network::read(folder.path() / "net.net.xml"), "two", "");
    EXPECT_THAT(svg, HasSubstr(">Side Street / Main Road</text>")) << "A, on both streets";
    EXPECT_THAT(svg, HasSubstr(">Main Road</text>")) << "B";
}

}  // namespace
}  // namespace clearway::scenario
