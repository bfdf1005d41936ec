#include "report/console.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "report/html.hpp"
#include "report/sample.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

TEST(ConsoleTables, show_the_dissertations_table_with_its_numbers_beside_ours) {
    const std::string text = console_tables(tests::study({"merge"}));
    EXPECT_THAT(text, HasSubstr("TABLE II. PERFORMANCE ON MERGE\n"));
    EXPECT_THAT(
        text, HasSubstr("  Baseline              11.3 +- 1.1   7.2 0.31 +- 0.12   1.2  12.4 +- 2.2  12.8\n"));
    EXPECT_THAT(text, HasSubstr("  Graph made by          9.9 +- 1.1   5.5"));
}

StudyFacts planned_study() {
    StudyFacts study = tests::study({"merge"});
    study.plan.emplace();
    analysis::PlannedFinding shown;
    shown.comparison = {"links act", "", "linked", "links_cut", results::Claim::difference};
    shown.scenario = "merge";
    shown.pairs = 20;
    shown.difference = analysis::Estimate{20, -2.5, 1.0, analysis::Interval{-3.0, -2.0}};
    shown.p = 0.00001;
    shown.holm_p = 0.00002;
    shown.shown = analysis::Shown::better;
    analysis::PlannedFinding equivalent = shown;
    equivalent.comparison = {"no worse", "", "net", "memory", results::Claim::equivalence};
    equivalent.margin_s = 1.25;
    equivalent.p = equivalent.holm_p = 0.02;
    equivalent.shown = analysis::Shown::equivalent;
    study.planned = {shown, equivalent};
    return study;
}

TEST(ConsoleTables, print_what_a_plan_confirms_before_all_else) {
    const std::string text = console_tables(planned_study());
    EXPECT_TRUE(text.starts_with("Confirmatory: the 2 comparisons of the plan, in emergency_restricted"));
    EXPECT_THAT(text, HasSubstr("\nThe probability of any false finding is 0.05 at most (Holm)"));
    EXPECT_THAT(text, HasSubstr("links act (merge)\n    linked - links_cut "));
    EXPECT_THAT(text, HasSubstr("-2.50 [-3.00, -2.00]      20   <0.001  shown: less time\n"));
    EXPECT_THAT(text, HasSubstr("0.020  equivalent within 1.2 s"));
    StudyFacts vain = planned_study();
    vain.planned.back().shown = analysis::Shown::not_shown;
    EXPECT_THAT(console_tables(vain), HasSubstr("no equivalence within 1.2 s shown"));
    EXPECT_LT(text.find("Exploratory: everything below"), text.find("TABLE II"));
    for (const std::string& line : lines_of(text.substr(0, text.find("Exploratory"))))
        EXPECT_LE(line.size(), 100u) << line;
    EXPECT_THAT(console_tables(tests::study({"merge"})), Not(HasSubstr("Exploratory")));
}

TEST(ConsoleTables, say_whose_p_is_that_of_two_one_sided_tests) {
    EXPECT_THAT(console_tables(planned_study()), HasSubstr("two one-sided tests (TOST)"));
    StudyFacts differences = planned_study();
    differences.planned.resize(1);
    EXPECT_THAT(console_tables(differences), Not(HasSubstr("TOST")));
}

TEST(ConsoleTables, tell_planned_replications_from_complete_ones) {
    StudyFacts study = tests::study({"merge"});
    EXPECT_THAT(console_tables(study), HasSubstr("merge: 20 replications, "));
    study.scenarios[0].replications = 30;
    EXPECT_THAT(console_tables(study), HasSubstr("merge: 30 replications planned, 20 complete at most, "));
}

TEST(Page, begins_with_what_a_plan_confirms) {
    std::ostringstream page;
    write_html(planned_study(), page);
    EXPECT_LT(page.str().find("<section id=\"plan\">"), page.str().find("<section id=\"overview\">"));
    EXPECT_THAT(page.str(), HasSubstr("Findings of the plan: EV travel time, all: difference, s"));
}

TEST(JsonTables, hold_the_findings_of_a_plan) {
    EXPECT_LT(json_tables(planned_study()).find("\"plan\""),
              json_tables(planned_study()).find("\"headline\""));
    const auto json = nlohmann::json::parse(json_tables(planned_study()));
    ASSERT_EQ(json["plan"]["confirmatory"].size(), 2u);
    EXPECT_EQ(json["plan"]["confirmatory"][0]["shown"], "better");
    EXPECT_DOUBLE_EQ(json["plan"]["confirmatory"][0]["difference_s"]["low"], -3.0);
    EXPECT_DOUBLE_EQ(json["plan"]["confirmatory"][1]["margin_s"], 1.25);
    EXPECT_FALSE(nlohmann::json::parse(json_tables(tests::study({"merge"}))).contains("plan"));
}

TEST(ConsoleTables, show_value_difference_intervals_and_effect_of_every_measure) {
    const std::string text = console_tables(tests::study({"city"}));
    EXPECT_THAT(text,
                HasSubstr("EV travel time, all, s\n"
                          "  Baseline              101.3  [96.9, 105.7]\n"
                          "  Graph made by          88.9  [84.5, 93.3]     -12.4  [-15.5, -9.3]  better\n"
                          "    simulation\n    attributes\n"));
    EXPECT_THAT(text, HasSubstr("+29.5  [21.0, 38.0]   worse\n"));
    EXPECT_THAT(text, HasSubstr("-0.6  [-3.4, 2.2]    none shown\n"));
    for (const MeasureInfo& measure : measures()) {
        EXPECT_THAT(text, HasSubstr(std::string("\n") + measure.title + ", " + measure.unit));
    }
}

TEST(ConsoleTables, tell_of_the_condition_of_the_map_although_others_before_it_are_left_out) {
    StudyFacts study = tests::study({"merge"});
    ScenarioFacts& scenario = study.scenarios[0];
    scenario.roads->signals.emplace_back();
    scenario.map->signal_trips = {{40, {-20.0, -22.0}}, {20, {0.5, 0.7}}};
    const std::string told = "40 of 60 trips pass a signal";
    EXPECT_THAT(console_tables(study), HasSubstr(told));
    // Two settings of it, each turned alone: the table of sensitivities has them.
    study.sensitivities = {{"merge", "graph_simulation", {{"a.one", "", {{"one", "5", {}, {}, ""}}}}}};
    ConditionFacts level = scenario.conditions[1];
    level.condition.name = "one";
    scenario.conditions.insert(scenario.conditions.begin() + 1, level);
    scenario.map->condition = "graph_simulation";
    EXPECT_THAT(console_tables(study), HasSubstr(told));
}

TEST(ConsoleTables, fit_a_terminal_of_100_columns) {
    StudyFacts study = tests::study({"merge", "bologna"});
    study.scenarios[0].conditions[1].failed = {{3, std::string(400, 'x') + " " + std::string(50, 'y')}};
    for (const std::string& line : lines_of(console_tables(study))) {
        EXPECT_LE(line.size(), 80u) << line;
    }
}

TEST(ConsoleTables, leave_out_the_published_table_where_there_is_none) {
    const std::string text = console_tables(tests::study({"bologna"}));
    EXPECT_THAT(text, Not(HasSubstr("TABLE")));
    EXPECT_THAT(text, HasSubstr("EV travel time, all, s\n"));
}

TEST(ConsoleTables, mark_conditions_without_safety_checks_and_failed_runs) {
    StudyFacts study = tests::study({"merge"});
    study.scenarios[0].conditions[3].condition.safety_checks = traffic::SafetyChecks::off;
    study.scenarios[0].conditions[2].failed = {{7, "signal: killed by signal 6"}};
    const std::string text = console_tables(study);
    EXPECT_THAT(text, HasSubstr("Same failures, no repair (!)"));
    EXPECT_THAT(text, HasSubstr("(!): the simulator's safety checks were off"));
    EXPECT_THAT(
        text, HasSubstr("Failed: GraphSAGE, corrected inputs: 1 run of 21; first: replication 7, signal\n"));
    EXPECT_THAT(text, Not(HasSubstr("killed by"))) << "standard error tells it, once";
}

TEST(ConsoleTables, of_one_replication_say_that_there_is_no_interval) {
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        for (const MeasureInfo& measure : measures()) {
            for (MaybeEstimate* const estimate : {&tests::value(condition, measure.measure),
                                                  &tests::difference(condition, measure.measure)}) {
                if (*estimate) *estimate = analysis::Estimate{1, (*estimate)->mean, 0.0, std::nullopt};
            }
        }
    }
    const std::string text = console_tables(study);
    EXPECT_THAT(text, HasSubstr("too few seeds\n"));
    EXPECT_THAT(text, HasSubstr("no verdict: too few seeds, 1 of at least 5"));
    EXPECT_THAT(text, Not(HasSubstr("+- ")));
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    EXPECT_THAT(text, Not(HasSubstr("better\n")));
}

TEST(ConsoleTables, survive_a_condition_whose_runs_all_failed) {
    StudyFacts study = tests::study({"merge"});
    ConditionFacts empty = tests::empty_condition("broken", "broken");
    empty.baseline = "baseline";
    empty.failed = {{0, "simulator: no route"}, {1, "simulator: no route"}};
    study.scenarios[0].conditions[1] = empty;
    const std::string text = console_tables(study);
    EXPECT_THAT(text, HasSubstr("broken: 2 of 2 runs failed; no verdict: no complete pair of runs."));
    EXPECT_THAT(text, HasSubstr("Failed: broken: 2 runs of 2"));
    EXPECT_GT(text.find("Failed: broken"), text.find("Time loss, others")) << "where a terminal shows it";
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    EXPECT_THAT(text, Not(HasSubstr("\n  broken"))) << "no row of dashes";
}

TEST(ConsoleTables, are_left_out_where_all_that_was_to_be_compared_failed) {
    StudyFacts study = tests::study({"merge"});
    ConditionFacts empty = tests::empty_condition("broken", "broken");
    empty.baseline = "baseline";
    empty.failed = {{0, "simulator: no route"}};
    study.scenarios[0].conditions.resize(1);
    EXPECT_THAT(console_tables(study), HasSubstr("Measure, condition")) << "a baseline alone has its means";
    study.scenarios[0].conditions.push_back(empty);
    for (const Tables tables : {Tables::essential, Tables::all}) {
        const std::string text = console_tables(study, tables);
        EXPECT_THAT(text, Not(HasSubstr("Measure, condition")));
        EXPECT_THAT(text, Not(HasSubstr("median")));
        EXPECT_THAT(text, Not(HasSubstr("\n  Baseline")));
        EXPECT_THAT(text, HasSubstr("broken: 1 of 1 run failed; no verdict: no complete pair of runs."));
    }
}

TEST(ConsoleTables, have_one_table_of_ev_travel_time_where_all_arrived) {
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        tests::value(condition, Measure::emergency_travel_time) = condition.value(primary);
        tests::difference(condition, Measure::emergency_travel_time) = condition.difference(primary);
    }
    EXPECT_THAT(console_tables(study),
                HasSubstr("\nEV travel time, arrived only, s: the same as of all\n\n"));
    tests::value(study.scenarios[0].conditions[0], Measure::emergency_travel_time)->mean += 1.0;
    EXPECT_THAT(console_tables(study), HasSubstr("\nEV travel time, arrived only, s\n  "));
}

TEST(ConsoleTables, have_the_figures_of_a_long_title_beside_it) {
    StudyFacts study = tests::study({"merge"});
    study.scenarios[0].conditions[1].title = "Ours: green corridor with lane clearing";
    const std::string text = console_tables(study);
    EXPECT_THAT(text,
                HasSubstr("\n  Ours: green            88.9  [84.5, 93.3]     -12.4  [-15.5, -9.3]  better\n"
                          "    corridor with\n    lane clearing\n"));
    for (const std::string& line : lines_of(text))
        EXPECT_LE(line.size(), 80U) << line;
}

TEST(ConsoleTables, leave_out_what_has_dashes_alone) {
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& condition : study.scenarios[0].conditions)
        tests::value(condition, primary) = tests::difference(condition, primary) = {};
    EXPECT_THAT(console_tables(study),
                AllOf(Not(HasSubstr("EV travel time, all, s")), HasSubstr("Time loss, others, s")));
    for (ConditionFacts& condition : study.scenarios[0].conditions)
        for (const MeasureInfo& measure : measures())
            tests::value(condition, measure.measure) = tests::difference(condition, measure.measure) = {};
    EXPECT_THAT(console_tables(study), Not(HasSubstr("Measure, condition")));
}

TEST(ConsoleTables, say_emergency_vehicle_before_they_say_ev) {
    const std::string text = console_tables(tests::study({"city"}));
    EXPECT_EQ(text.find("EV"), text.find("emergency vehicles (EV)") + 20);
    EXPECT_THAT(text, HasSubstr("60 emergency vehicles (EV)"));
}

TEST(ConsoleTables, warn_of_a_demand_without_emergency_vehicles) {
    StudyFacts study = tests::study({"city"});
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        condition.emergency = {};
        for (const MeasureInfo& measure : measures()) {
            if (measure.relevance != Relevance::least) continue;
            tests::value(condition, measure.measure).reset();
            tests::difference(condition, measure.measure).reset();
        }
    }
    const std::string text = console_tables(study);
    EXPECT_THAT(text, HasSubstr("The demand has no emergency vehicle (emergency = 0)"));
    EXPECT_THAT(text, HasSubstr("no verdict: the demand has no emergency vehicle"));
    EXPECT_THAT(text, Not(HasSubstr("EV travel time, all, s\n")));
    EXPECT_THAT(text, HasSubstr("Time loss, others, s\n"));
}

TEST(ConsoleTables, print_the_upper_end_of_an_interval_that_the_bound_at_zero_makes_lopsided) {
    StudyFacts study = tests::study({"merge"});
    tests::value(study.scenarios[0].conditions[0], Measure::emergency_depart_delay) =
        tests::between(0.5, 0.03, 8.0);
    const std::string text = console_tables(study);
    EXPECT_THAT(text, HasSubstr(" 0.50 (<8.00)"));
    EXPECT_THAT(console_tables(study, Tables::all), HasSubstr("(<x)"));
}

TEST(ConsoleTables, show_lost_emergency_vehicles_beside_the_means_of_those_that_arrived) {
    StudyFacts study = tests::study({"city"});
    ConditionFacts& condition = study.scenarios[0].conditions[1];
    condition.objections.emergency = {.arrived = 47, .teleported = 13};
    condition.objections.baseline_emergency = {.arrived = 60};
    condition.condition.policies = {"corridor"};
    const std::string text = console_tables(study);
    EXPECT_THAT(text, HasSubstr("[-15.5, -9.3]  lost EVs\n"));
    EXPECT_THAT(text, Not(HasSubstr("[-15.5, -9.3]  better\n")));
    EXPECT_THAT(console_tables(study, Tables::essential), Not(HasSubstr("Actions:")));
    EXPECT_THAT(console_tables(study, Tables::all),
                HasSubstr("Actions: Graph made by simulation attributes: asked for nothing.\n"));
}

TEST(ConsoleTables, end_on_the_verdicts_and_keep_the_legend_for_all_tables) {
    const std::string text = console_tables(tests::study({"city"}), Tables::essential);
    const std::size_t verdict = text.find("Graph made by simulation attributes: helped: EV travel time");
    ASSERT_NE(verdict, std::string::npos);
    EXPECT_GT(verdict, text.find("Time loss, others, s"));
    EXPECT_LE(std::ranges::count(text.substr(verdict), '\n'), 16)
        << "four verdicts on a terminal of 24 lines";
    EXPECT_THAT(text, Not(HasSubstr("better or worse when its interval")));
    EXPECT_THAT(console_tables(tests::study({"city"}), Tables::all), HasSubstr("diff.: mean of the"));
}

TEST(ConsoleTables, say_over_which_runs_means_and_differences_are) {
    StudyFacts study = tests::study({"merge"});
    const auto text = [&] {
        std::string tables = console_tables(study, Tables::essential);
        std::ranges::replace(tables, '\n', ' ');
        return tables;
    };
    EXPECT_THAT(text(), Not(HasSubstr("Means are over the runs")));
    ScenarioFacts& scenario = study.scenarios[0];
    for (ConditionFacts& condition : scenario.conditions)
        condition.complete_runs = 4;
    scenario.conditions[1].complete_runs = 2;
    tests::difference(scenario.conditions[1], primary)->n = 2;
    EXPECT_EQ(
        uneven_runs_sentence(scenario),
        "Means are over the runs that there are, differences over pairs of runs with the same seed alone, so "
        "they need not agree: " +
            scenario.conditions[0].label() + " 4, " + scenario.conditions[1].label() + " 2, 2 pairs.");
    EXPECT_THAT(text(), HasSubstr("Means are over the runs that there are"));
}

TEST(ConsoleTables, let_no_name_steer_the_terminal) {
    StudyFacts study = tests::study({"\x1b[2Jcity"});
    EXPECT_THAT(console_tables(study), Not(HasSubstr("\x1b")));
}

TEST(JsonTables, hold_every_measure_with_its_unit_in_the_name) {
    const auto json = nlohmann::json::parse(json_tables(tests::study({"merge"})));
    const auto& baseline = json["scenarios"][0]["conditions"][0];
    const auto& simulation = json["scenarios"][0]["conditions"][1];
    EXPECT_EQ(json["scenarios"][0]["name"], "merge");
    EXPECT_TRUE(baseline["compared_with"].is_null());
    EXPECT_EQ(simulation["compared_with"], "baseline");
    EXPECT_DOUBLE_EQ(simulation["measures"]["emergency_travel_time_s"]["difference"]["mean"], -12.4);
    EXPECT_EQ(simulation["measures"]["emergency_travel_time_s"]["effect"], "better");
    EXPECT_EQ(simulation["measures"]["emergency_restricted_travel_time_s"]["effect"], "better");
    EXPECT_EQ(simulation["objections"]["emergency_lost"], 0);
    EXPECT_DOUBLE_EQ(simulation["measures"]["emergency_waiting_time_s"]["published"], 5.5);
    EXPECT_FALSE(simulation["measures"]["emergency_travel_time_s"].contains("published"));
    EXPECT_TRUE(baseline["measures"]["gap_closed"]["mean"].is_null());
    EXPECT_EQ(baseline["measures"].size(), measure_count);
}

TEST(JsonTables, say_that_no_one_met_an_incident) {
    StudyFacts study = tests::study({"merge"});
    ScenarioFacts& scenario = study.scenarios[0];
    const auto met = [&] {
        return nlohmann::json::parse(json_tables(study))["scenarios"][0]["conditions"][1].contains(
            "met_incident");
    };
    EXPECT_FALSE(met());
    scenario.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0, 0.0, true}};
    tests::set_total(scenario.conditions[0], "emergency_met_incident", 0);
    EXPECT_TRUE(met());
}

TEST(JsonTables, survive_names_that_are_not_utf_8) {
    const auto json = nlohmann::json::parse(json_tables(tests::study({"\xff\xfe"})));
    EXPECT_EQ(json["scenarios"].size(), 1u);
}

TEST(ConsoleTables, answer_for_a_control_tell_of_it_under_its_condition_and_name_blocked_roads) {
    StudyFacts study = tests::study({"merge"});
    ScenarioFacts& scenario = study.scenarios[0];
    scenario.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0}};
    ASSERT_GE(scenario.conditions.size(), 3U);
    ConditionFacts& control = scenario.conditions[2];
    ASSERT_TRUE(control.is_compared());
    const std::string verdict = "\n" + control.label() + ": ";
    EXPECT_THAT(console_tables(study, Tables::essential),
                AllOf(HasSubstr(verdict), HasSubstr("Blocked: e1 from 80 to 980 s")));
    control.control_of = scenario.conditions[1].name();
    control.same_as = scenario.conditions[0].name();
    const std::string fact = "  - Every run is identical";
    const std::string beside = "\nFor comparison, " + control.label() + ": ";
    EXPECT_THAT(
        console_tables(study, Tables::essential),
        AllOf(HasSubstr(beside), HasSubstr("Controls: with one part of it off"), Not(HasSubstr(fact))))
        << "the answer alone";
    EXPECT_THAT(console_tables(study, Tables::all), AllOf(HasSubstr(beside), HasSubstr(fact)));
}

StudyFacts study_with_response() {
    StudyFacts study = tests::study({"merge"});
    ScenarioFacts& scenario = study.scenarios[0];
    scenario.response_threshold_s = 85.0;
    for (ConditionFacts& condition : scenario.conditions) {
        condition.response.percentile_90_s = tests::between(92.0, 88.0, 99.0);
        condition.response.percentile_90_difference_s = tests::between(-21.5, -30.0, -14.0);
        condition.response.in_time = tests::between(0.75, 0.6, 0.9);
        condition.response.in_time_difference = tests::between(0.25, -0.125, 0.375);
    }
    return study;
}

TEST(ConsoleTables, show_response_times_and_the_share_in_time) {
    EXPECT_THAT(
        console_tables(study_with_response(), Tables::essential),
        AllOf(Not(HasSubstr("90th percentile")),
              HasSubstr("\nEV trips within 85 s (100 s per km of the mean EV route unless given), %\n")));
    const std::string text = console_tables(study_with_response(), Tables::all);
    EXPECT_THAT(text, HasSubstr("\nEV response time, 90th percentile, s\n"));
    EXPECT_THAT(text, HasSubstr("92.0  [88.0, 99.0]"));
    EXPECT_THAT(text, HasSubstr("-21.5  [-30.0, -14.0] better\n"));
    EXPECT_THAT(text,
                HasSubstr("\nEV trips within 85 s (100 s per km of the mean EV route unless given), %\n"));
    EXPECT_THAT(text, HasSubstr("+25.0  [-12.5, 37.5]  none shown\n"));
    for (const std::string& line : lines_of(text))
        EXPECT_LE(line.size(), 100u) << line;
    EXPECT_THAT(console_tables(tests::study({"merge"})), Not(HasSubstr("EV response time")));
    StudyFacts few = study_with_response();
    for (ConditionFacts& condition : few.scenarios[0].conditions)
        condition.response.percentile_90_difference_s->n = fewest_to_trust - 1;
    EXPECT_THAT(console_tables(few), HasSubstr("-21.5  [-30.0, -14.0] few seeds\n"));
}

TEST(ConsoleTables, show_how_signals_served_emergency_vehicles) {
    StudyFacts study = tests::study({"merge"});
    ConditionFacts& condition = study.scenarios[0].conditions[1];
    tests::set_total(condition, "signal_calls", 90);
    tests::metric(condition, "signal_calls").estimate = tests::around(4.5, 0.5);
    tests::metric(condition, "signal_calls_granted").estimate = tests::around(3.5, 0.5);
    tests::metric(condition, "signal_recovery_s").estimate = tests::around(42.0, 2.0);
    const std::string text = console_tables(study, Tables::all);
    EXPECT_THAT(text, HasSubstr("calls granted useless entry s green s  hold s  back s\n"));
    EXPECT_THAT(text, HasSubstr("4.5     3.5       -       -       -       -    42.0\n"));
    EXPECT_THAT(console_tables(study, Tables::essential), Not(HasSubstr("Signals, mean of runs")));
    tests::set_total(condition, "signal_calls", 0);
    EXPECT_THAT(console_tables(study, Tables::all), Not(HasSubstr("Signals, mean of runs")));
}

TEST(JsonTables, hold_response_times) {
    const auto json = nlohmann::json::parse(json_tables(study_with_response()));
    const auto& condition = json["scenarios"][0]["conditions"][1];
    EXPECT_EQ(json["scenarios"][0]["response_threshold_s"], 85.0);
    EXPECT_EQ(condition["response_percentile_90_s"]["mean"], 92.0);
    EXPECT_EQ(condition["response_in_time_1"]["difference"]["mean"], 0.25);
}

}  // namespace
}  // namespace clearway::report
