#include "report/text.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "report/published.hpp"
#include "report/sample.hpp"

namespace clearway::report {
namespace {

TEST(Escaped, leaves_nothing_that_opens_or_closes_markup) {
    EXPECT_EQ(escaped("<script>alert('x' && \"y\")</script>"),
              "&lt;script&gt;alert(&#39;x&#39; &amp;&amp; &quot;y&quot;)&lt;/script&gt;");
}

TEST(Escaped, replaces_control_characters) {
    EXPECT_EQ(escaped(std::string("a\x1b[2Jb\0c", 8)), "a\uFFFD[2Jb\uFFFDc");
    EXPECT_EQ(escaped("tab\tand\nline, Wegedornstra\u00dfe"), "tab\tand\nline, Wegedornstra\u00dfe");
}

TEST(Number, has_the_decimals_asked_for) {
    EXPECT_EQ(number(12.345, {.decimals = 1}), "12.3");
    EXPECT_EQ(number(12.345, {.decimals = 0}), "12");
    EXPECT_EQ(number(-12.345, {.decimals = 2}), "-12.35");
    EXPECT_EQ(number(-12.345, {2, Script::typeset}), "\u221212.35");
    EXPECT_EQ(number(12.345, {.decimals = 1, .sign = Sign::always}), "+12.3");
}

TEST(Number, never_prints_a_signed_zero_or_nan) {
    EXPECT_EQ(number(-0.04, {.decimals = 1, .sign = Sign::always}), "0.0");
    EXPECT_EQ(number(-0.0, {.decimals = 0}), "0");
    EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN(), {}), "-");
    EXPECT_EQ(number(std::numeric_limits<double>::infinity(), {1, Script::typeset}), "\u2013");
}

TEST(EstimateText, shows_the_interval_only_where_there_is_one) {
    EXPECT_EQ(estimate(tests::between(8.0, 6.5, 9.5), {}), "8.0 [6.5, 9.5]");
    EXPECT_EQ(estimate(tests::between(8.0, 6.5, 9.5, 4), {}), "8.0");
    EXPECT_EQ(estimate({}, {}), "-");
    const NumberStyle with_sign{.sign = Sign::always};
    EXPECT_EQ(estimate(tests::between(1.0, -2.0, 4.0), with_sign), "+1.0 [-2.0, 4.0]");
    EXPECT_EQ(estimate(tests::between(1.0, -2.0, 4.0), {.sign = Sign::ends_too}), "+1.0 [-2.0, +4.0]");
    EXPECT_EQ(estimate(tests::between(0.41, 0.28, 0.54), {.decimals = 0}, 100.0), "41 [28, 54]");
}

TEST(IntervalText, shows_that_an_interval_excludes_0) {
    const NumberStyle style{.decimals = 1};
    EXPECT_EQ(interval_text({-2.0, -0.03}, style), "[-2.0, -0.03]");
    EXPECT_EQ(interval_text({0.001, 2.0}, style), "[0.001, 2.0]");
    EXPECT_EQ(interval_text({0.000001, 2.0}, style), "[0.0000, 2.0]") << "no longer than four decimals";
    EXPECT_EQ(interval_text({-0.03, 2.0}, style), "[0.0, 2.0]") << "it includes 0";
    EXPECT_EQ(interval_text({0.0, 2.0}, style), "[0.0, 2.0]");
}

TEST(TableRow, has_its_figures_beside_the_first_line_of_its_label) {
    EXPECT_EQ(table_row("  short", 12, "1.0  [0.5, 1.5]  \n"), "  short     1.0  [0.5, 1.5]\n");
    EXPECT_EQ(table_row("  eleven let", 12, "1.0"), "  eleven    1.0\n    let\n") << "one column stays free";
    EXPECT_EQ(table_row("Ours: a green corridor", 12, "1.0"), "Ours: a     1.0\n  green\n  corridor\n");
    EXPECT_EQ(table_row("mine+failure=B10", 12, "1.0"), "mine+       1.0\n  failure=\n  B10\n");
    EXPECT_EQ(table_row("nowheretobreak", 12, "1.0"), "nowheretobr 1.0\n  eak\n");
    EXPECT_EQ(table_row("Stra\u00dfe frei", 12, "1.0"), "Stra\u00dfe frei 1.0\n") << "characters, not bytes";
    EXPECT_EQ(table_row("", 4, "1.0"), "    1.0\n");
}

TEST(Decimals, grow_where_all_means_are_small) {
    const ScenarioFacts scenario = tests::scenario("merge");
    EXPECT_EQ(decimals_of(scenario, Measure::emergency_travel_time), 1);
    EXPECT_EQ(decimals_of(scenario, Measure::emergency_depart_delay), 2);
    EXPECT_EQ(decimals_of(scenario, Measure::gap_closed), 0);
}

TEST(Counts, are_grouped_and_agree_in_number) {
    EXPECT_EQ(grouped(0), "0");
    EXPECT_EQ(grouped(999), "999");
    EXPECT_EQ(grouped(1234567), "1,234,567");
    EXPECT_EQ(counted(1, "run"), "1 run");
    EXPECT_EQ(counted(20, "run"), "20 runs");
}

TEST(Published, are_the_cells_of_the_dissertations_tables_and_no_others) {
    EXPECT_EQ(published_value("merge", "baseline", Measure::emergency_waiting_time), 7.2);
    EXPECT_EQ(published_value("intersection", "graph_simulation", Measure::waiting_time), 3.2);
    EXPECT_EQ(published_value("city", "graph_graphsage", Measure::emergency_depart_delay), 0.8);
    EXPECT_EQ(published_value("city", "graph_graphsage_as_published", Measure::emergency_depart_delay), 0.8);
    EXPECT_EQ(published_value("city", "graph_graphsage_improved", Measure::emergency_depart_delay),
              std::nullopt);
    EXPECT_EQ(published_value("city", "solo", Measure::waiting_time), std::nullopt);
    EXPECT_EQ(published_value("bologna", "baseline", Measure::waiting_time), std::nullopt);
    EXPECT_EQ(published_value("merge", "baseline", Measure::emergency_travel_time), std::nullopt);
}

TEST(Published, captions_name_the_scenario_where_it_is_a_variant) {
    ScenarioFacts scenario = tests::scenario("merge");
    EXPECT_EQ(published_caption(scenario), "TABLE II. PERFORMANCE ON MERGE");
    scenario.name = "merge_dense";
    EXPECT_EQ(published_caption(scenario), "TABLE II. PERFORMANCE ON MERGE (here: merge_dense)");
    scenario.published_as = "";
    EXPECT_EQ(published_caption(scenario), "");
}

}  // namespace
}  // namespace clearway::report
