#include "report/detail/axes.hpp"

#include <map>
#include <regex>
#include <tuple>

#include <gmock/gmock.h>

#include "report/detail/figures.hpp"

namespace clearway::report::detail {
namespace {

using ::testing::DoubleEq;
using ::testing::Pointwise;

Range range(double low, double high) {
    Range result;
    result.include(low);
    result.include(high);
    return result;
}

TEST(NiceTicks, are_multiples_of_one_two_or_five) {
    EXPECT_THAT(nice_ticks(range(0, 100), 5).values,
                Pointwise(DoubleEq(), {0.0, 20.0, 40.0, 60.0, 80.0, 100.0}));
    EXPECT_THAT(nice_ticks(range(-17, 42), 5).values, Pointwise(DoubleEq(), {0.0, 20.0, 40.0}));
    EXPECT_THAT(nice_ticks(range(3, 7.4), 5).values, Pointwise(DoubleEq(), {3.0, 4.0, 5.0, 6.0, 7.0}));
}

TEST(DecadeTicks, ArePowersOfTenAndAtMostSeven) {
    EXPECT_THAT(decade_ticks(range(-1, 2)).values, Pointwise(DoubleEq(), {0.1, 1.0, 10.0, 100.0}));
    EXPECT_THAT(decade_ticks(range(-4, 5)).values, Pointwise(DoubleEq(), {1e-4, 1e-2, 1.0, 1e2, 1e4}));
}

TEST(LogarithmicAxis, GivesDecadesOneWidthAndKeepsZeroAtItsLowEnd) {
    const Axis axis{range(-2, 2), "", 100.0, 0.0, Scale::logarithmic};
    EXPECT_DOUBLE_EQ(axis.place(1.0), 50.0);
    EXPECT_DOUBLE_EQ(axis.place(10.0), 25.0);
    EXPECT_DOUBLE_EQ(axis.place(1e-9), 100.0);
    EXPECT_DOUBLE_EQ(axis.place(0.0), 100.0);
}

TEST(NiceTicks, have_decimals_that_tell_neighbours_apart) {
    EXPECT_EQ(nice_ticks(range(0, 1), 5).decimals, 1);
    EXPECT_EQ(nice_ticks(range(0, 0.12), 5).decimals, 2);
    EXPECT_EQ(nice_ticks(range(0, 5000), 5).decimals, 0);
}

TEST(Range, of_equal_values_can_be_drawn) {
    const Range padded_range = padded(range(70, 70), 0.05);
    EXPECT_LT(padded_range.low, 70.0);
    EXPECT_GT(padded_range.high, 70.0);
    EXPECT_FALSE(nice_ticks(padded_range, 5).values.empty());
}

TEST(Range, ignores_what_is_not_finite) {
    Range result;
    result.include(std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE(result.empty());
}

TEST(Plot, escapes_its_texts) {
    Plot plot("<b>", 100.0, {range(0, 1), "<i>", 10, 90}, {range(0, 1), "", 80, 10});
    plot.grid_x();
    plot.text(1, 1, "<script>", Plot::Anchor::start, "label");
    const std::string svg = plot.finish();
    EXPECT_THAT(svg, ::testing::HasSubstr("&lt;script&gt;"));
    EXPECT_THAT(svg,
                ::testing::Not(::testing::AnyOf(::testing::HasSubstr("<script"), ::testing::HasSubstr("<i>"),
                                                ::testing::HasSubstr("<b>"))));
}

TEST(BarPlaces, give_signals_that_stand_close_one_bar_with_what_the_strictest_shows) {
    JourneyFacts journey;
    journey.signals = {{"A", "red", 100.0, 0.0, 20.0},   {"A", "green", 100.0, 20.0, 60.0},
                       {"B", "green", 115.0, 0.0, 30.0}, {"B", "yellow", 115.0, 30.0, 33.0},
                       {"B", "red", 115.0, 33.0, 60.0},  {"C", "green", 140.0, 0.0, 60.0}};
    const BarPlaces close({&journey}, 20.0);
    std::vector<std::tuple<double, std::string, double, double>> bars;
    for (const SignalSpan& bar : close.bars_of(journey))
        bars.emplace_back(bar.distance_m, bar.state, bar.from_s, bar.to_s);
    using Bar = decltype(bars)::value_type;
    EXPECT_THAT(bars, ::testing::ElementsAre(Bar(100.0, "red", 0.0, 20.0), Bar(100.0, "green", 20.0, 30.0),
                                             Bar(100.0, "yellow", 30.0, 33.0), Bar(100.0, "red", 33.0, 60.0),
                                             Bar(140.0, "green", 0.0, 60.0)));
    EXPECT_EQ(close.note(),
              " Signals less than 20 m behind another share its bar, which shows the strictest of them.");
    const BarPlaces apart({&journey}, 15.0);
    EXPECT_EQ(apart.bars_of(journey).size(), 6u);
    EXPECT_EQ(apart.note(), "");
}

/// The words of a legend, by line, each with its place from the left.
std::map<double, std::vector<std::pair<double, std::string>>> lines_of_legend(
    const std::vector<LegendEntry>& entries) {
    Canvas canvas("", 100.0);
    canvas.legend(entries);
    const std::string svg = canvas.finish();
    const std::regex words("<text class=\"legend\" x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*>([^<]*)<");
    std::map<double, std::vector<std::pair<double, std::string>>> lines;
    for (std::sregex_iterator at(svg.begin(), svg.end(), words), end; at != end; ++at)
        lines[std::stod((*at)[2])].emplace_back(std::stod((*at)[1]), (*at)[3]);
    return lines;
}

TEST(Legend, leaves_no_entry_alone_on_a_line_that_could_share_it) {
    const auto entry = [](const char* words) { return line_entry({.number = 1}, words); };
    const auto lines = lines_of_legend(
        {{"", "failure:"}, entry("perfect"), entry("outages"), entry("noise"), entry("lost messages")});
    ASSERT_EQ(lines.size(), 2u);
    const auto& [first, second] = std::pair(lines.begin()->second, lines.rbegin()->second);
    EXPECT_EQ(first.front().second, "failure:");
    EXPECT_EQ(second.size(), 2u) << "with the one before, as the first line has the heading";
    EXPECT_EQ(second.back().second, "lost messages");
    EXPECT_DOUBLE_EQ(second.front().first, first[1].first) << "behind the heading";
    EXPECT_EQ(lines_of_legend({{"", "failure:"}, entry("perfect"), entry("lost")}).size(), 1u);
}

}  // namespace
}  // namespace clearway::report::detail
