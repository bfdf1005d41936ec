#include "scenario/outlook.hpp"

#include <gmock/gmock.h>

#include "core/files.hpp"
#include "roads/route.hpp"
#include "support/crossing_scene.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::scenario {
namespace {

using ::testing::HasSubstr;
using Ways = std::vector<std::vector<std::string>>;

/// Vehicles an hour from edge to edge over two crossings with two phases each, 41 s of green in 90 s, and two
/// lanes on every approach.
Outlook two_crossings_with(const std::map<std::pair<std::string, std::string>, double>& turns) {
    const roads::Network& network = testing::two_crossings();
    PlannedRoutes others;
    for (const auto& [edges, count] : turns)
        others.turns[{network.find_edge(edges.first).value(), network.find_edge(edges.second).value()}] =
            count;
    return outlook(network, {testing::eastbound}, others, 3600.0);
}

TEST(Outlook, adds_up_the_red_of_the_signals_of_a_trip_and_its_time_at_the_limits) {
    const roads::Network& network = testing::two_crossings();
    std::vector<core::EdgeIndex> way;
    for (const std::string& id : testing::eastbound)
        way.push_back(network.find_edge(id).value());
    const Outlook found = outlook(network, {testing::eastbound, {"B_east"}}, {}, 3600.0);
    EXPECT_EQ(found.signals, 2U);
    EXPECT_EQ(found.trips, 2U);
    EXPECT_EQ(found.trips_passing, 1U);
    EXPECT_DOUBLE_EQ(found.signals_a_trip, 1.0) << "two, and none";
    EXPECT_DOUBLE_EQ(found.red_s, 49.0 * 49.0 / 180.0);
    const double limit_mps = network.lane(network.lane_of(way.front(), 0)).speed_limit_mps;
    const double driven_m = roads::route_length(network, way).value + network.edge(way.back()).length_m;
    EXPECT_NEAR(found.trip_s - found.red_s, driven_m / limit_mps / 2.0, 0.5);
}

TEST(Outlook, tells_the_red_of_each_signal_of_a_trip) {
    const auto waits_s = red_waits_s(testing::two_crossings(), testing::eastbound);
    ASSERT_EQ(waits_s.size(), 2U);
    for (const auto& [signal, wait_s] : waits_s)
        EXPECT_DOUBLE_EQ(wait_s, 49.0 * 49.0 / 180.0) << signal.value;
    EXPECT_TRUE(red_waits_s(testing::two_crossings(), {"B_east"}).empty());
}

TEST(Outlook, waits_once_at_a_signal_with_two_stop_lines_on_the_way) {
    const support::TemporaryFolder folder;
    std::string text = core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    const std::size_t program = text.find("<tlLogic id=\"B\"");
    text.erase(program, text.find("<junction", program) - program);
    for (std::size_t at = 0; (at = text.find("tl=\"B\"", at)) != std::string::npos;)
        text[at + 4] = 'A';
    const roads::Network network = roads::Network::read(folder.write("joined.net.xml", text));
    const Outlook found = outlook(network, {testing::eastbound}, {}, 3600.0);
    EXPECT_DOUBLE_EQ(found.signals_a_trip, 1.0);
    EXPECT_DOUBLE_EQ(found.red_s, 49.0 * 49.0 / 180.0);
}

TEST(Outlook, knows_the_degree_of_saturation_of_a_flow) {
    const Outlook one = two_crossings_with({{{"north_a_A", "A_south_a"}, 1000.0}});
    EXPECT_DOUBLE_EQ(one.fullest_degree, 1000.0 / (2 * 1800.0 * 41.0 / 90.0));
    EXPECT_EQ(one.fullest, "A");
    EXPECT_EQ(one.full, 0U);
    const Outlook right = two_crossings_with({{{"north_b_B", "B_A"}, 800.0}});
    EXPECT_DOUBLE_EQ(right.fullest_degree, 800.0 / (1800.0 * 41.0 / 90.0)) << "from one lane";
    EXPECT_EQ(right.fullest, "B");
    const Outlook shared =
        two_crossings_with({{{"north_b_B", "B_A"}, 600.0}, {{"north_b_B", "B_south_b"}, 1000.0}});
    EXPECT_DOUBLE_EQ(shared.fullest_degree, 1600.0 / (2 * 1800.0 * 41.0 / 90.0)) << "of both turns together";
    EXPECT_EQ(right.full, 1U);
}

TEST(Outlook, costs_the_others_where_full_flows_compete_for_green) {
    const std::pair<std::string, std::string> east = {"west_A", "A_B"}, west = {"B_A", "A_west"};
    const Outlook both_ways = two_crossings_with({{east, 1600.0}, {west, 1600.0}});
    EXPECT_EQ(both_ways.full, 1U);
    EXPECT_EQ(both_ways.contested, 0U) << "they have green together";
    EXPECT_EQ(both_ways.prospect(), Prospect::helps);
    const Outlook left_turn = two_crossings_with({{{"west_A", "A_north_a"}, 800.0}, {west, 1600.0}});
    EXPECT_EQ(left_turn.contested, 0U) << "it waits for a gap in their common green";
    const Outlook right_turns =
        two_crossings_with({{{"west_A", "A_south_a"}, 800.0}, {{"north_a_A", "A_west"}, 800.0}});
    EXPECT_EQ(right_turns.full, 1U);
    EXPECT_EQ(right_turns.contested, 0U) << "their ways do not meet";
    const Outlook across = two_crossings_with({{east, 1600.0}, {{"north_a_A", "A_south_a"}, 1500.0}});
    EXPECT_EQ(across.contested, 1U);
    EXPECT_EQ(across.prospect(), Prospect::costs_others);
    EXPECT_THAT(outlook_sentence(across),
                HasSubstr("By programs and trips alone, preemption is likely to help EVs and may cost the "
                          "others: EVs pass 2.0 signals a "
                          "trip, and red without queues costs 27 s of a trip of "));
    EXPECT_THAT(outlook_sentence(across),
                HasSubstr("compete for green at 1 of 2 signals (the fullest, at 1.0 "
                          "times its capacity, is at A)."));
    EXPECT_EQ(two_crossings_with({{east, 1600.0}, {{"north_a_A", "A_south_a"}, 1400.0}}).contested, 0U);
}

TEST(Outlook, tells_signals_on_loops_of_short_blocks) {
    EXPECT_EQ(outlook(testing::short_square(), {{"A0A1", "A1B1"}}, {}, 3600.0).on_short_loops, 1U);
    EXPECT_EQ(outlook(testing::two_crossings(), {testing::eastbound}, {}, 3600.0).on_short_loops, 0U);
}

TEST(Outlook, tells_signals_that_wait_long_for_people_on_foot) {
    const support::TemporaryFolder folder;
    std::string text = core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/footway.net.xml");
    const auto slow_walks = [&] {
        const roads::Network network = roads::Network::read(folder.write("footway.net.xml", text));
        return outlook(network, {{"in", "out"}}, {}, 3600.0).slow_walks;
    };
    EXPECT_EQ(slow_walks(), 0U) << "4 s of walk and 5 s to clear";
    const std::string clearance = "<phase duration=\"5\"  state=\"rrr\"/>";
    text.replace(text.find(clearance), clearance.size(), "<phase duration=\"12\" state=\"rrr\"/>");
    EXPECT_EQ(slow_walks(), 1U);
}

TEST(OutlookSentence, says_why_little_can_be_gained) {
    EXPECT_EQ(outlook_sentence({}),
              "By programs and trips alone, preemption has little to gain: the network has no signal.");
    EXPECT_EQ(outlook_sentence({.signals = 3}),
              "By programs and trips alone, preemption has little to gain: no trip of an EV is planned.");
    EXPECT_EQ(outlook_sentence({.signals = 3, .trips = 6, .trip_s = 100.0}),
              "By programs and trips alone, preemption has little to gain: none of 6 trips of EVs "
              "passes a signal.");
    Outlook few{
        .signals = 3, .trips = 6, .trips_passing = 1, .signals_a_trip = 0.2, .red_s = 4.0, .trip_s = 219.0};
    EXPECT_EQ(outlook_sentence(few),
              "By programs and trips alone, preemption has little to gain: few EVs pass a signal (1 of 6), "
              "and red without queues costs 4 s of a trip of "
              "219 s.");
    few.trips_passing = 3;
    few.passed = 2;
    few.full = 1;
    EXPECT_EQ(outlook_sentence(few),
              "By programs and trips alone, preemption has little to gain: EVs pass 0.2 signals a trip, and "
              "red without queues costs 4 s of a trip of "
              "219 s, but "
              "queues at full approaches (at 1 of 2 signals) may cost more.");
}

TEST(OutlookSentence, says_what_helps_and_what_stands_in_the_way) {
    Outlook some{
        .signals = 9, .trips = 6, .trips_passing = 6, .signals_a_trip = 3.2, .red_s = 38.0, .trip_s = 160.0};
    some.passed = 4;
    some.on_short_loops = 1;
    EXPECT_EQ(outlook_sentence(some),
              "By programs and trips alone, preemption is likely to help: EVs pass 3.2 signals a trip, and "
              "red without queues costs 38 s of a trip of "
              "160 s.");
    some.on_short_loops = 4;
    some.slow_walks = 2;
    EXPECT_THAT(outlook_sentence(some),
                HasSubstr("; 4 of the 4 signals on their ways lie on loops of short blocks, where the others "
                          "hardly gain; 2 of "
                          "the 4 signals on their ways first wait over 15 s for people on foot."));
    some.red_s = 11.0;
    EXPECT_EQ(some.prospect(), Prospect::little) << "0.069 of the trip";
    EXPECT_EQ(outlook_json(some)["prospect"], "little");
    EXPECT_EQ(outlook_json(some)["sentence"], outlook_sentence(some));
}

TEST(PlannedRoutes, count_vehicles_and_turns) {
    const support::TemporaryFolder folder;
    const auto file =
        folder.write("traffic.rou.xml",
                     "<routes><vehicle id=\"a\" depart=\"0\"><route edges=\"west_A A_B B_east\"/></vehicle>"
                     "<vehicle id=\"b\" depart=\"1\"><route edges=\"west_A A_B\"/></vehicle>"
                     "<vehicle id=\"c\" depart=\"2\"><route edges=\"A_B\"/></vehicle></routes>");
    const roads::Network& network = testing::two_crossings();
    const PlannedRoutes routes = planned_routes(file, network);
    EXPECT_EQ(routes.vehicles, 3U);
    EXPECT_EQ(routes.single, 1U);
    const auto edge = [&](const char* id) { return network.find_edge(id).value(); };
    EXPECT_EQ(routes.turns.size(), 2U);
    EXPECT_EQ(routes.turns.at({edge("west_A"), edge("A_B")}), 2.0);
    EXPECT_EQ(routes.turns.at({edge("A_B"), edge("B_east")}), 1.0);
}

}  // namespace
}  // namespace clearway::scenario
