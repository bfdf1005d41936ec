#include "report/map.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "report/detail/grid.hpp"
#include "report/detail/map_canvas.hpp"

namespace clearway::report {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Optional;

MapEdge edge(const std::string& id, double length_m, std::vector<std::size_t> to) {
    return {id, std::move(to), false, length_m, 10.0, {{0.0, 0.0}, {length_m, 0.0}}};
}

/// 0 -> 1 -> 3, and the longer way 0 -> 2 -> 3; 4 leads to 0 and nothing leads to it.
RoadMap diamond() {
    RoadMap map;
    map.edges = {edge("start", 100.0, {1, 2}), edge("short", 200.0, {3}), edge("long", 900.0, {3}),
                 edge("end", 50.0, {}), edge("behind", 70.0, {0})};
    return map;
}

TEST(TimesFrom, TakeTheFastestWayAndCountBothEnds) {
    const RoadMap map = diamond();
    EXPECT_THAT(times_from(map, {0}, {10.0, 20.0, 5.0, 7.0, 1.0}),
                ElementsAre(Optional(DoubleEq(10.0)), Optional(DoubleEq(30.0)), Optional(DoubleEq(15.0)),
                            Optional(DoubleEq(22.0)), Eq(std::nullopt)));
}

/// The number behind `attribute` in the `text` element of a drawing that holds `words`; -1 without one.
double number_of(const std::string& svg, const std::string& words, const std::string& attribute) {
    const std::size_t at = svg.find(">" + words);
    if (at == std::string::npos) return -1.0;
    const std::size_t found = svg.find(attribute + "=\"", svg.rfind("<text", at));
    return std::stod(svg.substr(found + attribute.size() + 2));
}

TEST(MapCanvas, keeps_the_credit_clear_of_what_stands_beside_the_scale_bar) {
    const RoadMap map = diamond();  // flat: drawn wider across, which a long text beside the bar says
    detail::MapCanvas canvas("t", map);
    canvas.scale_bar();
    canvas.credit("Map data: somebody");
    const std::string svg = canvas.finish();
    EXPECT_THAT(svg, ::testing::HasSubstr("times as wide across"));
    EXPECT_GE(number_of(svg, "Map data", " y") - number_of(svg, "100 m", " y"), 14.0);
}

TEST(MapCanvas, of_signals_that_stand_close_together_draws_them_apart) {
    RoadMap map;
    map.edges = {edge("along", 4000.0, {})};
    map.edges.front().shape = {{0.0, 0.0}, {4000.0, 3000.0}};
    map.signals = {{"a", {1000.0, 800.0}}, {"b", {1200.0, 900.0}}};
    map.stations = {{"along", "hospital", "Far away"}};
    const auto apart = [&](const detail::MapCanvas& canvas) {
        return canvas.place(map.signals[1].place).first - canvas.place(map.signals[0].place).first;
    };
    detail::MapCanvas canvas = detail::MapCanvas::of_signals("t", map);
    EXPECT_GT(apart(canvas), 5.0 * apart(detail::MapCanvas("t", map)));
    canvas.stations(map);
    EXPECT_THAT(canvas.finish(), ::testing::Not(::testing::HasSubstr("Far away")));
}

TEST(MapCanvas, breaks_a_long_credit_into_two_lines_below_the_scale_bar) {
    detail::MapCanvas canvas("t", diamond());
    canvas.scale_bar();
    canvas.credit(
        "Scenarios of the project Example (Author and Author 2015), shipped by a simulator, package tools");
    const std::string svg = canvas.finish();
    EXPECT_THAT(svg,
                ::testing::HasSubstr(">Scenarios of the project Example (Author and Author 2015),</text>"));
    EXPECT_THAT(svg, ::testing::HasSubstr(">shipped by a simulator, package tools</text>"));
    EXPECT_GE(number_of(svg, "Scenarios", " y") - number_of(svg, "100 m", " y"), 14.0);
    EXPECT_GE(number_of(svg, "shipped", " y") - number_of(svg, "Scenarios", " y"), 11.0);
}

TEST(MapCanvas, writes_the_names_of_stations_in_full_and_the_kind_of_those_without) {
    RoadMap map = diamond();
    map.stations = {{map.edges[0].id, "hospital", "Institut Mon\u00e9gasque de M\u00e9decine du Sport"},
                    {map.edges[1].id, "fire_station", ""}};
    map.edges[1].shape = {{0.0, 300.0}, {0.0, 310.0}};
    detail::MapCanvas canvas("t", map);
    canvas.stations(map);
    const std::string svg = canvas.finish();
    EXPECT_THAT(svg, ::testing::AllOf(::testing::HasSubstr(">Institut Mon\u00e9gasque de<"),
                                      ::testing::HasSubstr(">M\u00e9decine du Sport<"),
                                      ::testing::HasSubstr(">fire station<"),
                                      ::testing::Not(::testing::HasSubstr("\u2026"))));
}

TEST(MapCanvas, calls_stations_in_a_legend_what_they_are) {
    RoadMap map;
    map.stations = {{"a", "hospital", "Gate"}, {"b", "hospital", ""}};
    EXPECT_EQ(detail::station_words(map), "hospital");
    map.stations.push_back({"a", "fire_station", ""});
    EXPECT_EQ(detail::station_words(map), "hospital or fire station");
}

TEST(MapCanvas, moves_a_station_s_name_that_would_lie_on_another_and_leaves_out_kinds_without_room) {
    RoadMap map = diamond();
    map.stations = {{map.edges[0].id, "hospital", ""},
                    {map.edges[0].id, "hospital", "Gate"},
                    {map.edges[0].id, "fire_station", "Hill"}};
    detail::MapCanvas canvas("t", map);
    canvas.stations(map);
    std::string svg = canvas.finish();
    const double apart = std::hypot(number_of(svg, "Gate", " x") - number_of(svg, "Hill", " x"),
                                    number_of(svg, "Gate", " y") - number_of(svg, "Hill", " y"));
    EXPECT_GE(number_of(svg, "Hill", " x"), 0.0) << "written, too";
    EXPECT_GE(apart, 12.0) << "a line's height";
    map.stations.assign(9, {map.edges[0].id, "hospital", ""});
    detail::MapCanvas full("t", map);
    full.stations(map);
    svg = full.finish();
    std::size_t kinds = 0;
    for (std::size_t at = svg.find(">hospital"); at != std::string::npos; at = svg.find(">hospital", at + 1))
        ++kinds;
    EXPECT_GE(kinds, 1U);
    EXPECT_LE(kinds, 4U) << "sides of one sign";
}

TEST(Grid, writes_intervals_into_cells_that_are_wide_enough_for_them) {
    using Tone = detail::GridCell::Tone;
    const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f"};
    const std::vector<detail::GridCell> cells(6, {"-11.1", Tone::better, "[-20.8, -1.5]"});
    const std::string svg = detail::draw_grids("t", {{"h", names, {{"B10", cells}}}}, {"unit: s"}).finish();
    EXPECT_THAT(svg, ::testing::HasSubstr(">[-20.8, -1.5]<"));
    EXPECT_GT(number_of(svg, "f<", " y"), number_of(svg, "a<", " y")) << "six do not fit into one row";
    EXPECT_THAT(svg, ::testing::HasSubstr(">unit: s<"));
}

TEST(Grid, breaks_long_headings_of_columns_so_that_none_meets_its_neighbour) {
    const std::vector<std::string> names = {"Green", "corridor", "preempt_signals", "check_in_out",
                                            "line_of_sight_far_away"};
    const std::string svg =
        detail::draw_grids("t", {{"h", names, {{"B10", std::vector<detail::GridCell>(5)}}}}).finish();
    EXPECT_GT(number_of(svg, "signals<", " y"), number_of(svg, "preempt_<", " y"));
    EXPECT_EQ(number_of(svg, "Green<", " y"), number_of(svg, "signals<", " y")) << "they stand on the cells";
    EXPECT_EQ(number_of(svg, "preempt_signals", " y"), -1.0);
    EXPECT_THAT(svg, ::testing::HasSubstr("line_of_<"));
}

TEST(TimesFrom, SeveralStartsUseTheNearest) {
    const RoadMap map = diamond();
    EXPECT_THAT(times_from(map, {0, 1}, {10.0, 20.0, 90.0, 7.0, 1.0}),
                ElementsAre(Optional(DoubleEq(10.0)), Optional(DoubleEq(20.0)), Optional(DoubleEq(100.0)),
                            Optional(DoubleEq(27.0)), Eq(std::nullopt)));
}

TEST(Reach, UsesMeasuredTimesWhereVehiclesDroveAndLengthensTheOthersAlike) {
    const RoadMap map = diamond();
    // At the limit of 10 m/s the first edge takes 10 s: without the condition thrice that, with it twice.
    const auto reach = reach_of(map, {{0, 4, 30.0, 20.0}}, {0}, 240.0);
    ASSERT_TRUE(reach);
    EXPECT_DOUBLE_EQ(reach->delay, 3.0);
    EXPECT_THAT(reach->edges[1].baseline_s, Optional(DoubleEq(30.0 + 3.0 * 20.0)));
    EXPECT_THAT(reach->edges[1].condition_s, Optional(DoubleEq(20.0 + 3.0 * 20.0)));
    EXPECT_TRUE(reach->edges[0].driven);
    EXPECT_FALSE(reach->edges[1].driven);
    EXPECT_EQ(reach->minutes, 2.0);
    EXPECT_DOUBLE_EQ(reach->baseline_m(map, 90.0), 300.0);
    EXPECT_DOUBLE_EQ(reach->condition_m(map, 90.0), 300.0) << "no gain where nobody drove";
}

TEST(Reach, WeighsDelaysByPassages) {
    const RoadMap map = diamond();
    const auto reach = reach_of(map, {{0, 3, 20.0, 10.0}, {1, 1, 20.0, 20.0}}, {0}, 10.0);
    EXPECT_DOUBLE_EQ(reach->delay, (3 * 20.0 + 20.0) / (3 * 10.0 + 20.0));
    EXPECT_EQ(reach->minutes, 1.0);  // at least one
}

TEST(Reach, NeedsStartsAndTimes) {
    const RoadMap map = diamond();
    EXPECT_FALSE(reach_of(map, {}, {0}, 100.0));
    EXPECT_FALSE(reach_of(map, {{0, 4, 30.0, 20.0}}, {}, 100.0));
}

}  // namespace
}  // namespace clearway::report
