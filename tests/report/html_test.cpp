#include "report/html.hpp"

#include <algorithm>
#include <cctype>

#include <gmock/gmock.h>

#include "report/page.hpp"
#include "report/sample.hpp"

namespace clearway::report {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

std::string page_of(const StudyFacts& study) {
    return tests::without_script(tests::page_of(study));
}

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++count;
    }
    return count;
}

TEST(Page, holds_verdict_tables_figures_outcomes_and_reproduction) {
    const std::string page = page_of(tests::study({"merge", "city"}));
    for (const char* const id : {"overview", "verdict", "tables", "differences", "travel-time", "cost",
                                 "journeys", "enough", "training", "outcomes", "reproduce"}) {
        EXPECT_THAT(page, HasSubstr("<section id=\"" + std::string(id) + "\">"));
        EXPECT_THAT(page, HasSubstr("<a href=\"#" + std::string(id) + "\">"));
    }
    EXPECT_THAT(page, HasSubstr("TABLE IV. PERFORMANCE ON CITY NETWORK"));
    EXPECT_THAT(page, HasSubstr("<span class=\"mean\">88.9</span><span class=\"range\">[84.5, 93.3]</span>"
                                "<span class=\"delta better\">\u221212.4 [\u221215.5, \u22129.3]</span>"));
    EXPECT_THAT(page, HasSubstr("<td class=\"published\" data-label=\"published\">4.8</td>"));
    EXPECT_THAT(page, HasSubstr("./clearway study studies/dissertation.toml"));
    EXPECT_THAT(page, HasSubstr(">58</td>"));
}

TEST(Page, says_the_name_of_an_imported_scenario_once) {
    StudyFacts study = tests::study({"city"});
    study.scenarios[0].title = study.scenarios[0].name + ", imported from map.osm";
    EXPECT_THAT(page_of(study),
                HasSubstr("<h3>" + study.scenarios[0].name + "<small>imported from map.osm</small></h3>"));
}

TEST(Page, marks_coarse_steps_on_the_first_screen_and_at_the_verdicts) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("(!) steps of")));
    study.scenarios[0].step_length_s = 1.0;
    EXPECT_EQ(count_of(page_of(study), "<p class=\"note\">(!) steps of 1 s: use them only"), 2U);
}

TEST(Page, says_at_the_tables_over_which_runs_means_are) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("Means are over the runs")));
    --study.scenarios[0].conditions[1].complete_runs;
    EXPECT_THAT(page_of(study), HasSubstr("<p class=\"note\">Means are over the runs that there are"));
}

TEST(Page, leaves_out_sections_that_have_nothing_to_show) {
    const std::string page = page_of(tests::study({"merge"}));
    EXPECT_THAT(page, Not(HasSubstr("id=\"networks\"")));
    EXPECT_THAT(page, Not(HasSubstr("#networks")));
}

TEST(Page, has_the_data_of_every_plot_beside_it) {
    const std::string page = page_of(tests::study({"merge", "city"}));
    EXPECT_EQ(count_of(page, "<svg class=\"plot\""),
              25u);  // two scenarios: map, trip, gain and cost, differences, travel time, its pairs, cost,
                     // recovery, two journeys, precision; the reach of one; two trainings
    EXPECT_EQ(count_of(page, "<summary>Data</summary>"), 25u);
}

TEST(Page, marks_locks_on_the_map_with_crosses) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("class=\"lock")));
    study.scenarios[0].map->locks = {{0, 2, 1}, {2, 0, 3}};
    const std::string page = page_of(study);
    EXPECT_EQ(count_of(page, "<path class=\"lock\""), 2u);  // One on the map, one in its legend.
    EXPECT_EQ(count_of(page, "<path class=\"lock before\""), 1u);
    EXPECT_THAT(page, HasSubstr("vehicles locked each other"));
}

TEST(Page, marks_blocked_roads_on_the_map) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("road blocked for a while")));
    report::RoadMap& roads = *study.scenarios[0].roads;
    roads.incidents = {{roads.edges[0].id, 60.0, 900.0}, {"not-there", 0.0, 1.0}};
    const std::string page = page_of(study);
    EXPECT_EQ(count_of(page, "<circle class=\"block\""), 2u);  // One on the map, one in its legend.
    EXPECT_THAT(page, HasSubstr("road blocked for a while"));
    EXPECT_THAT(page, Not(HasSubstr("No EV met the block")));
    roads.incidents[0].is_closed = true;
    tests::set_total(study.scenarios[0].conditions[0], "emergency_met_incident", 0);
    EXPECT_THAT(page_of(study),
                HasSubstr("<h4>Those that met the incident</h4><p class=\"figure\">0</p><p>No EV met"));
}

/// Of five streets of the sample's grid, of which the first and the last are on both ways.
ChangedWay changed_way(const std::string& vehicle, double gain_s) {
    return {vehicle, 0, {0, 2, 4, 7, 18}, {0, 3, 14, 16, 18}, 100.0 + gain_s, 100.0};
}

TEST(Page, gives_no_colour_to_edges_that_few_vehicles_passed) {
    StudyFacts study = tests::study({"merge"});
    std::vector<EdgeTimes>& times = study.scenarios[0].map->times;
    for (EdgeTimes& one : times)
        one.passages = 5;
    const std::string few = page_of(study);
    EXPECT_EQ(count_of(few, "class=\"way few\""), times.size() + 1) << "and the legend";
    EXPECT_EQ(count_of(few, "class=\"way better"), 0u);
    times.front().passages = 6;
    EXPECT_THAT(page_of(study), HasSubstr("class=\"way better much\""));
}

TEST(Page, draws_the_ways_that_were_changed_and_one_trip_on_both) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("One trip on two ways")));
    EXPECT_THAT(page_of(study), Not(HasSubstr("It took another way")));
    ScenarioMap& map = *study.scenarios[0].map;
    map.trips = 9;
    map.changed_ways = {changed_way("small", 1.0), changed_way("median", 7.0), changed_way("large", 90.0)};
    report::RoadMap& roads = *study.scenarios[0].roads;
    roads.incidents = {{roads.edges[4].id, 60.0, 900.0}};
    std::string page = page_of(study);
    EXPECT_THAT(page, HasSubstr("3 of 9 trips took another way"));
    EXPECT_EQ(count_of(page, "class=\"way taken\""), 4u) << "three streets and the legend";
    EXPECT_THAT(page, HasSubstr("more EVs than in the baseline"));
    EXPECT_EQ(count_of(page, "class=\"way left\""), 4u);
    EXPECT_THAT(page, HasSubstr("One trip on two ways"));
    EXPECT_THAT(page,
                HasSubstr("Vehicle median, replication 0. Of 9 trips that both conditions have, 3 took"));
    EXPECT_THAT(page, HasSubstr("Baseline: 0.95 km, 107 s"));
    EXPECT_EQ(count_of(page, "<circle class=\"block\""), 4u) << "on both maps and in their legends";
    EXPECT_THAT(page, Not(HasSubstr("It took another way")));

    // The trip over time is shown, if it has two ways.
    map.changed_ways[2].vehicle = study.scenarios[0].journeys.front().vehicle;
    page = page_of(study);
    EXPECT_THAT(page, HasSubstr("It took another way with the condition: each line follows its own."));
    EXPECT_THAT(page, HasSubstr("it is the trip over time, too"));

    // Of trips that did not end alike no picture compares the times.
    for (ChangedWay& change : map.changed_ways)
        change.condition.back() = 20;
    EXPECT_THAT(page_of(study), Not(HasSubstr("One trip on two ways")));
}

TEST(Page, draws_the_ways_that_were_considered_and_not_taken) {
    StudyFacts study = tests::study({"merge"});
    ScenarioMap& map = *study.scenarios[0].map;
    map.changed_ways = {changed_way("one", 1.0)};
    EXPECT_THAT(page_of(study), Not(HasSubstr("on a way considered, not taken")));
    map.considered = {{"one", 0, 5, 3}, {"one", 1, 6, 1}, {"another", 0, 5, 1004}};
    const std::string page = page_of(study);
    EXPECT_EQ(count_of(page, "on a way considered, not taken"), 2u) << "of the map, and of the one trip";
    EXPECT_EQ(count_of(page, "class=\"way considered\""), 5u) << "two edges, one, and the legends";
    EXPECT_THAT(page, HasSubstr(">1,007</td>")) << "decisions, of all vehicles";
}

TEST(Page, marks_places_of_calls_on_the_map) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("EVs are called here")));
    report::RoadMap& roads = *study.scenarios[0].roads;
    roads.calls = {{roads.edges[0].id, 60.0, 2}, {"not-there", 0.0, 1}};
    const std::string page = page_of(study);
    EXPECT_EQ(count_of(page, "<circle class=\"call\""), 2u);  // One on the map, one in its legend.
    EXPECT_THAT(page, HasSubstr("EVs are called here"));
}

TEST(Page, tells_all_that_is_known_of_a_paired_difference) {
    const std::string page = page_of(tests::study({"merge"}));
    EXPECT_THAT(page, HasSubstr("Statistics of the paired differences"));
    for (const char* const cell : {">\u22121.87</td>", ">&lt;0.001</td>", ">0.002</td>", ">20</td>"}) {
        EXPECT_THAT(page, HasSubstr(cell));
    }
    EXPECT_THAT(page, HasSubstr("id=\"enough\""));
    EXPECT_THAT(page, HasSubstr(">141</td>"));
    EXPECT_THAT(page, ContainsRegex(">812</td><td[^>]*>31</td><td[^>]*>640</td>"));
}

TEST(Page, loads_nothing_from_elsewhere) {
    std::string page = page_of(tests::study({"merge"}));
    std::transform(page.begin(), page.end(), page.begin(),
                   [](unsigned char letter) { return std::tolower(letter); });
    for (const char* const forbidden : {"http://", "https://", "src=", "@import", "url(", "<script",
                                        "<iframe", "javascript:", "href=\"/", "href=\"."}) {
        EXPECT_THAT(page, Not(HasSubstr(forbidden)));
    }
}

TEST(Page, escapes_every_text_that_comes_from_files) {
    const std::string evil = "\"><script>alert('x')</script><b onclick=\"";
    StudyFacts study = tests::study({"merge"});
    study.title = study.command = evil;
    study.provenance = {{evil, evil}};
    study.curves[0].title = study.curves[0].note = study.curves[0].held_out = evil;
    ScenarioFacts& scenario = study.scenarios[0];
    scenario.name = scenario.title = scenario.attribution = scenario.map->condition = evil;
    scenario.network_svg = "<svg class=\"network\" viewBox=\"0 0 1 1\"></svg>";
    for (ConditionFacts& condition : scenario.conditions) {
        condition.condition.name = condition.title = condition.recipe = evil;
        if (condition.is_compared()) condition.baseline = evil;
        condition.failed = {{1, evil}};
    }
    const std::string page = page_of(study);
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_THAT(page, Not(HasSubstr("<b onclick")));
    EXPECT_GE(count_of(page, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;"), 30u);
}

TEST(Page, explains_colours_of_signals_only_where_they_are) {
    const auto trip_of = [](const StudyFacts& study) {
        const std::string page = page_of(study);
        const std::size_t begin = page.find("id=\"trip-merge\"");
        return page.substr(begin, page.find("</figure>", begin) - begin);
    };
    StudyFacts study = tests::study({"merge"});
    const std::string with = trip_of(study);
    for (const char* const text : {">red</text>", ">yellow</text>", ">green</text>", "drawn twice",
                                   ">Baseline, upper bars</text>", ", lower bars</text>"})
        EXPECT_THAT(with, HasSubstr(text));
    for (JourneyFacts& journey : study.scenarios[0].journeys)
        std::erase_if(journey.signals, [](const SignalSpan& span) { return span.state != "green"; });
    EXPECT_THAT(trip_of(study), AllOf(HasSubstr(">green</text>"), Not(HasSubstr(">red</text>"))));
    for (JourneyFacts& journey : study.scenarios[0].journeys)
        journey.signals.clear();
    EXPECT_THAT(trip_of(study), AllOf(HasSubstr("No signal stands on its route."),
                                      Not(HasSubstr(">green</text>")), Not(HasSubstr(">red</text>")),
                                      Not(HasSubstr("drawn twice")), Not(HasSubstr(" bars<"))));
}

TEST(Page, tells_how_the_trip_that_it_shows_stands_among_all) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("arrived in both,")));
    std::vector<TripGain>& gains = study.scenarios[0].conditions[1].trip_changes.gains;
    gains = {
        {0, "emergency1", 30.0}, {0, "emergency0", 8.0}, {1, "emergency0", -2.0}, {1, "emergency1", 6.0}};
    EXPECT_THAT(page_of(study),
                HasSubstr("Of all 4 trips that arrived in both, 1 gain more; the median gain is 7 s."));
    gains.erase(gains.begin() + 1);
    EXPECT_THAT(page_of(study), Not(HasSubstr("arrived in both,"))) << "that trip did not";
}

TEST(Page, draws_one_trip_around_its_signals_where_these_stand_close_together) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("Drawn are metres")));
    for (JourneyFacts& journey : study.scenarios[0].journeys) {
        journey.places = {{0.0, 0.0}, {200.0, 2300.0}, {230.0, 2500.0}, {600.0, 8200.0}};
        journey.signals = {{"J1", "red", 2400.0, 0.0, 210.0}, {"J2", "green", 2460.0, 0.0, 240.0}};
    }
    EXPECT_THAT(page_of(study), HasSubstr("Drawn are metres 2250 to 2610 of 8200, around its signals."));
    for (JourneyFacts& journey : study.scenarios[0].journeys)
        journey.places = {{0.0, 0.0}, {600.0, 8200.0}};
    EXPECT_THAT(page_of(study), HasSubstr("Drawn are metres 2250 to 2610"))
        << "it passes without a corner there";
    const std::string page = page_of(study);
    const std::string red = "class=\"signal-red\" d=\"M";
    ASSERT_THAT(page, HasSubstr(red));
    EXPECT_GT(std::stod(page.substr(page.find(red) + red.size())), 0.0) << "bars begin at the frame";
}

TEST(Page, never_prints_nan_for_what_is_missing) {
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        const std::string baseline = condition.baseline;
        condition = tests::empty_condition(condition.name(), condition.title);
        condition.baseline = baseline;
        condition.failed = {{0, "simulator: no route"}};
    }
    const std::string page = page_of(study);
    EXPECT_THAT(page, Not(HasSubstr("nan")));
    EXPECT_THAT(page, HasSubstr("no verdict"));
    EXPECT_THAT(page, Not(HasSubstr("id=\"travel-time\"")));
    EXPECT_THAT(page, HasSubstr("simulator: no route"));
}

TEST(Page, of_an_empty_study_says_so) {
    EXPECT_THAT(page_of(StudyFacts{}), HasSubstr("No condition was compared with a baseline."));
}

TEST(Page, says_where_a_distribution_was_thinned) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), Not(HasSubstr("evenly spaced")));
    study.scenarios[0].conditions[0].distribution.arrived = 30000;
    EXPECT_THAT(page_of(study), HasSubstr("Drawn at 200 ranks, evenly spaced"));
}

TEST(Page, ends_the_axis_of_times_before_few_trips_that_would_take_much_of_it) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), HasSubstr(">EV travel time, s<"));
    std::vector<SharePoint>& points = study.scenarios[0].conditions[1].distribution.points;
    points[56].seconds = 1200.0;
    points[57].seconds = 1234.0;
    const std::string page = page_of(study);
    EXPECT_THAT(page, HasSubstr(">EV travel time (2 trips beyond, up to 1234 s), s<"));
    points[54].seconds = points[55].seconds = 1100.0;  // of 58, 4 are more than one in twenty
    EXPECT_THAT(page_of(study), HasSubstr(">EV travel time, s<"));
}

TEST(Page, doubts_costs_of_approaches_that_are_shown_alone) {
    StudyFacts study = tests::study({"merge"});
    const auto cost = [&] {
        const std::string page = page_of(study);
        const std::size_t begin = page.find("id=\"cost-merge\"");
        return page.substr(begin, page.find("</svg>", begin) - begin);
    };
    EXPECT_THAT(cost(), AllOf(HasSubstr(">+240<"), HasSubstr(">[180, 300]<"), Not(HasSubstr("after Holm")),
                              HasSubstr(">time lost by others per approach and run: difference [95 %], s<")));
    for (ConditionFacts& condition : study.scenarios[0].conditions)
        for (analysis::ApproachCost& approach : condition.approaches)
            approach.holm_p = approach.edge == "edge0" ? 0.2 : 0.04;
    EXPECT_THAT(cost(), AllOf(HasSubstr(">+240 \u2020<"), HasSubstr(">\u2212120<"), HasSubstr("after Holm")));
}

TEST(Page, draws_what_is_reached_only_where_a_difference_is_shown) {
    StudyFacts study = tests::study({"city"});
    EXPECT_THAT(tests::page_of(study), HasSubstr("id=\"reach-city\""));
    ScenarioFacts& scenario = study.scenarios[0];
    tests::difference(scenario.conditions[scenario.place_of(scenario.map->condition)], primary) =
        tests::around(-2.0, 3.0);
    EXPECT_THAT(tests::page_of(study), Not(HasSubstr("id=\"reach-city\"")));
}

TEST(Page, claims_no_recovery_where_no_interval_is_known) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(page_of(study), HasSubstr("recovered by 75 s"));
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        if (!condition.recovery) continue;
        condition.recovery->recovered_by_s.reset();
        for (analysis::RecoveryPoint& point : condition.recovery->points)
            point.difference->n = analysis::fewest_for_interval - 1;
    }
    EXPECT_THAT(page_of(study), AllOf(HasSubstr("too few passages to tell"), Not(HasSubstr("recovered by")),
                                      Not(HasSubstr("not recovered in"))));
}

TEST(Page, tells_recovery_that_is_open_from_one_that_is_shown_not_to_come) {
    StudyFacts study = tests::study({"merge"});
    const auto drawn = [&](std::optional<std::size_t> pairs_to_tell, bool stays_longer) {
        for (ConditionFacts& condition : study.scenarios[0].conditions) {
            if (!condition.recovery) continue;
            condition.recovery->recovered_by_s.reset();
            condition.recovery->pairs_to_tell = pairs_to_tell;
            condition.recovery->stays_longer = stays_longer;
        }
        return page_of(study);
    };
    EXPECT_THAT(drawn(24, false),
                AllOf(HasSubstr(">not told yet: about 24 seeds<"), Not(HasSubstr("recovered by"))));
    EXPECT_THAT(drawn(900, false), HasSubstr(">not told yet: over 200 seeds<"));
    EXPECT_THAT(drawn({}, false), HasSubstr(">not told yet<"));
    EXPECT_THAT(drawn({}, true), HasSubstr(">not recovered in this time<"));
}

TEST(Page, draws_at_most_six_recoveries_in_a_figure) {
    StudyFacts study = tests::study({"merge"});
    std::vector<ConditionFacts>& conditions = study.scenarios[0].conditions;
    while (std::ranges::count_if(conditions, [](const auto& one) { return one.recovery.has_value(); }) < 7)
        conditions.push_back(conditions[1]);
    const std::string page = page_of(study);
    EXPECT_THAT(page, AllOf(HasSubstr("id=\"recovery-merge-1\""), HasSubstr("merge (2 of 2)")));
    EXPECT_THAT(page, Not(HasSubstr("id=\"recovery-merge\"")));
    EXPECT_EQ(count_of(page, "recovered by 75 s"), 7u);
}

TEST(Page, lists_at_most_fifty_failures_of_a_condition_and_counts_the_rest) {
    StudyFacts study = tests::study({"merge"});
    for (std::uint32_t replication = 0; replication < 120; ++replication) {
        study.scenarios[0].conditions[1].failed.push_back({replication, "killed"});
    }
    const std::string page = page_of(study);
    EXPECT_EQ(count_of(page, "<td>killed</td>"), 50u);
    EXPECT_THAT(page, HasSubstr("120 runs failed"));
    EXPECT_THAT(page, HasSubstr("The first 50 are listed."));
}

}  // namespace
}  // namespace clearway::report
