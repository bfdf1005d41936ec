#include "report/verdict.hpp"

#include <gmock/gmock.h>

#include "report/console.hpp"
#include "report/lease_words.hpp"
#include "report/sample.hpp"
#include "report/shared_sentences.hpp"

namespace clearway::report {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

using tests::between;

TEST(Effect, of_less_than_what_counts_is_negligible) {
    EXPECT_EQ(effect_of(between(-0.2, -0.3, -0.1, 20), Better::lower, 1.0), Effect::negligible);
    EXPECT_EQ(effect_of(between(0.1, -0.3, 0.5, 20), Better::lower, 1.0), Effect::negligible)
        << "shown to be smaller than what counts";
    EXPECT_EQ(effect_of(between(-0.9, -1.7, -0.1, 20), Better::lower, 1.0), Effect::negligible);
    EXPECT_EQ(effect_of(between(-1.2, -1.7, -0.7, 20), Better::lower, 1.0), Effect::better);
    EXPECT_EQ(effect_of(between(-0.2, -2.0, 1.6, 20), Better::lower, 1.0), Effect::none_shown);
}

TEST(Effect, follows_from_the_interval_alone) {
    EXPECT_EQ(effect_of(between(-5.0, -9.0, -1.0, 20), Better::lower), Effect::better);
    EXPECT_EQ(effect_of(between(-5.0, -9.0, -1.0, 20), Better::higher), Effect::worse);
    EXPECT_EQ(effect_of(between(5.0, 1.0, 9.0, 20), Better::lower), Effect::worse);
    EXPECT_EQ(effect_of(between(5.0, 1.0, 9.0, 20), Better::higher), Effect::better);
    EXPECT_EQ(effect_of(between(-5.0, -11.0, 1.0, 20), Better::lower), Effect::none_shown);
}

TEST(Effect, counts_a_bound_of_zero_as_included) {
    EXPECT_EQ(effect_of(between(-5.0, -10.0, 0.0, 20), Better::lower), Effect::none_shown);
    EXPECT_EQ(effect_of(between(0.0, 0.0, 0.0, 20), Better::lower), Effect::none_shown);
}

TEST(Effect, of_fewer_than_five_pairs_is_not_told) {
    EXPECT_EQ(effect_of(analysis::Estimate{1, -50.0, 0.0, {}}, Better::lower), Effect::too_few);
    EXPECT_EQ(effect_of(between(-50.0, -51.0, -49.0, 4), Better::lower), Effect::too_few);
    EXPECT_EQ(effect_of(between(-50.0, -51.0, -49.0, 5), Better::lower), Effect::better);
    EXPECT_EQ(effect_of({}, Better::lower), Effect::undecided);
}

TEST(Verdict, says_helped_harmed_or_no_effect_shown) {
    const ScenarioFacts scenario = tests::scenario("merge");
    EXPECT_EQ(verdict(scenario, scenario.conditions[1], Script::plain).text(),
              "helped: EV travel time -12.4 s [-15.5, -9.3], -12 %. No effect shown on the others' time loss "
              "(+0.4 s [-0.8, 1.6]).");
    EXPECT_EQ(
        verdict(scenario, scenario.conditions[3], Script::plain).text(),
        "harmed: EV travel time +29.5 s [21.0, 38.0], +29 %. The others lose more time (+3.9 s [1.7, 6.1]).");
    EXPECT_THAT(verdict(scenario, scenario.conditions[4], Script::plain).text(),
                StartsWith("no effect shown: EV travel time -0.6 s [-3.4, 2.2], -1 %."));
}

TEST(Verdict, says_first_whom_an_incident_cut_off) {
    ScenarioFacts scenario = tests::scenario("merge");
    for (analysis::MetricSummary& metric : scenario.conditions[1].metrics)
        if (metric.metric.name == "emergency_cut_off") metric.values = {1.0, 0.0, 2.0};
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                StartsWith("3 EVs cut off by an incident; helped: "));
    // The baseline's EVs drive another way, as with another dispatch.
    scenario.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0, 0.0, true}};
    tests::set_total(scenario.conditions[0], "emergency_met_incident", 0);
    tests::set_total(scenario.conditions[1], "emergency_met_incident", 3);
    scenario.conditions[1].missing_runs = 2;
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                StartsWith("3 EVs cut off by an incident; 2 of 22 runs are missing; helped: "));
}

TEST(Verdict, says_how_many_did_not_arrive_and_why_where_the_baseline_lost_as_many) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.horizon_s = 3600.0;
    analysis::Objections& counts = scenario.conditions[1].objections;
    const auto facts = [&] { return verdict(scenario, scenario.conditions[1], Script::plain).facts; };
    EXPECT_THAT(facts(), Not(Contains(HasSubstr("emergency vehicles"))));
    counts.emergency = {.arrived = 17, .teleported = 4};
    counts.baseline_emergency = {.arrived = 16, .running_at_end = 1, .teleported = 4};
    const std::string arrived = "; EVs that arrived in both: -12.4 s [-15.5, -9.3]; median";
    const std::string horizon = "; one that did not arrive counts with 3600 s.";
    EXPECT_THAT(facts()[0], AllOf(StartsWith("Lost 4 of 21 emergency vehicles (4 teleported; baseline 4 "
                                             "teleported, 1 still on the road at the end)" +
                                             arrived),
                                  EndsWith(horizon)));
    EXPECT_EQ(facts()[1], "SUMO teleports an EV that has stood for time.time_to_teleport_s, as in a queue.");
    counts.emergency = {.arrived = 21};
    tests::comparison(scenario.conditions[1], Measure::emergency_travel_time).difference.reset();
    EXPECT_EQ(facts()[0],
              "Lost none of 21 emergency vehicles (baseline 4 teleported, 1 still on the road at the end)" +
                  horizon);
    counts.emergency = counts.baseline_emergency = {.arrived = 20, .running_at_end = 1};
    EXPECT_THAT(facts(), Not(Contains(HasSubstr("SUMO teleports"))));
}

TEST(Verdict, says_first_that_no_one_met_an_incident) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0, 0.0, true}};
    tests::set_total(scenario.conditions[0], "emergency_met_incident", 0);
    EXPECT_THAT(
        verdict(scenario, scenario.conditions[1], Script::plain).text(),
        StartsWith("no EV met the block (0 of 60 in the baseline), of which nothing is shown; helped: "));
}

TEST(Verdict, tells_who_met_an_incident_and_what_wrong_units_and_ways_cost) {
    ScenarioFacts scenario = tests::scenario("merge");
    const auto text = [&] { return verdict(scenario, scenario.conditions[1], Script::plain).text(); };
    EXPECT_THAT(text(), Not(AnyOf(HasSubstr("closed road"), HasSubstr("lost"), HasSubstr("missing"))));
    const auto set = [](ConditionFacts& condition, const char* name, const analysis::Values& values,
                        analysis::MaybeEstimate estimate) {
        for (analysis::MetricSummary& metric : condition.metrics) {
            if (metric.metric.name != name) continue;
            metric.values = values;
            metric.estimate = estimate;
        }
    };
    set(scenario.conditions[0], "emergency_met_incident", {2.0, 3.0}, {});
    set(scenario.conditions[1], "emergency_met_incident", {1.0, 0.0}, {});
    scenario.conditions[1].met_incident = {5, 1, tests::around(-9.0, 3.0)};
    set(scenario.conditions[1], "wrong_unit_share", {}, analysis::Estimate{5, 0.25, 0.0, {}});
    set(scenario.conditions[1], "unit_regret_s", {}, analysis::Estimate{5, 8.125, 0.0, {}});
    set(scenario.conditions[1], "way_regret_s", {}, analysis::Estimate{5, 1.5, 0.0, {}});
    set(scenario.conditions[1], "units_missing", {1.0, 0.0}, {});
    EXPECT_THAT(
        text(),
        HasSubstr(" 1 EV came to a closed road (baseline: 5, whose trips change by -9.0 [-12.0, -6.0] s). "
                  "The wrong unit in 25 % of decisions, 8.1 s "
                  "lost each. Against the best way, 1.5 s lost on each. 1 called unit missing."));
}

TEST(Verdict, does_not_call_a_fifth_of_a_second_help) {
    ScenarioFacts scenario = tests::scenario("merge");
    tests::difference(scenario.conditions[1], primary) = tests::around(-0.2, 0.1);
    scenario.conditions[1].least_relevant_s = 1.0;
    EXPECT_THAT(
        verdict(scenario, scenario.conditions[1], Script::plain).text(),
        StartsWith("no relevant effect: EV travel time -0.2 s [-0.3, -0.1], 0 %, where 1.0 s would count."));
}

TEST(Verdict, of_no_effect_says_that_the_network_has_no_signals) {
    ScenarioFacts scenario = tests::scenario("merge");
    const auto of_four = [&] { return verdict(scenario, scenario.conditions[4], Script::plain).text(); };
    EXPECT_THAT(of_four(), Not(HasSubstr("signals")));
    scenario.roads->signals.clear();
    scenario.conditions[4].condition.policies = {"clear_lane"};
    EXPECT_THAT(of_four(), Not(HasSubstr("signals"))) << "it asks for none";
    scenario.conditions[4].condition.policies = {"clear_lane", "preempt_signals"};
    EXPECT_THAT(of_four(),
                StartsWith("no effect shown: EV travel time -0.6 s [-3.4, 2.2], -1 %; the network has "
                           "no signals, so signal policies have no effect."));
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(), Not(HasSubstr("signals")));
}

TEST(CoarseSteps, are_marked_above_a_quarter_of_a_second) {
    StudyFacts study = tests::study({"merge"});
    study.scenarios.front().step_length_s = 0.25;
    EXPECT_EQ(coarse_step_sentence(study.scenarios.front().step_length_s), "");
    EXPECT_THAT(console_tables(study), Not(HasSubstr("steps of")));
    study.scenarios.front().step_length_s = 1.0;
    EXPECT_THAT(coarse_step_sentence(study.scenarios.front().step_length_s),
                StartsWith("steps of 1 s: use them only to compare"));
    EXPECT_THAT(console_tables(study), HasSubstr("steps of 1 s: use them only to compare"));
}

TEST(FewSeeds, are_named_below_ten) {
    StudyFacts study = tests::study({"merge"});
    study.scenarios.front().replications = 10;
    EXPECT_EQ(few_seeds_sentence(study), "");
    study.scenarios.front().replications = 9;
    EXPECT_THAT(few_seeds_sentence(study),
                StartsWith("few seeds: means and intervals from fewer than 10 seeds"));
    study.scenarios.front().replications = 4;
    EXPECT_THAT(few_seeds_sentence(study), StartsWith("too few seeds: fewer than 5 give no interval"));
}

TEST(Verdict, names_collisions_when_their_interval_excludes_zero) {
    ScenarioFacts scenario = tests::scenario("merge");
    tests::difference(scenario.conditions[1], Measure::collisions) = tests::around(4.5, 1.5);
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                EndsWith(" More collisions (+4.50 per run [3.00, 6.00])."));
}

TEST(Verdict, says_that_safety_checks_were_off) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].condition.safety_checks = traffic::SafetyChecks::off;
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(), HasSubstr("Safety checks"));
}

/// The measured case: seven survivors are hardly slower, thirteen of twenty teleport.
ScenarioFacts survivors_only() {
    ScenarioFacts scenario = tests::scenario("merge");
    ConditionFacts& condition = scenario.conditions[4];
    condition.objections.emergency = {.arrived = 7, .teleported = 13};
    condition.objections.baseline_emergency = {.arrived = 20};
    tests::difference(condition, Measure::emergency_restricted_time) = tests::around(500.0, 90.0);
    tests::difference(condition, Measure::emergency_travel_time) = tests::around(1.7, 4.0);
    return scenario;
}

TEST(Verdict, says_first_how_many_emergency_vehicles_were_lost) {
    ScenarioFacts scenario = survivors_only();
    ConditionFacts& condition = scenario.conditions[4];
    EXPECT_THAT(
        verdict(scenario, condition, Script::plain).text(),
        StartsWith("lost 13 of 20 emergency vehicles (13 teleported; baseline 0) and harmed: EV travel "
                   "time +500.0 s [410.0, 590.0]"));
    for (const double mean : {-30.0, 0.0, 0.2}) {
        tests::difference(condition, Measure::emergency_restricted_time) = tests::around(mean, 0.5);
        const std::string text = verdict(scenario, condition, Script::plain).text();
        EXPECT_THAT(text, StartsWith("lost 13 of 20 emergency vehicles"));
        for (const char* const claim : {"helped", "no effect shown: ", "no relevant effect"})
            EXPECT_THAT(text, Not(HasSubstr(claim)));
    }
}

TEST(Effect, of_a_condition_that_loses_emergency_vehicles_is_worse_or_ruled_out) {
    const ScenarioFacts scenario = survivors_only();
    const ConditionFacts& condition = scenario.conditions[4];
    EXPECT_EQ(effect_of(condition, Measure::emergency_restricted_time), Effect::worse);
    EXPECT_EQ(effect_of(condition, Measure::emergency_travel_time), Effect::ruled_out);
    EXPECT_EQ(effect_of(condition, Measure::other_time_loss), Effect::none_shown);
}

TEST(Verdict, never_calls_a_condition_without_safety_checks_a_help) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].condition.safety_checks = traffic::SafetyChecks::off;
    scenario.conditions[1].objections.unchecked = true;
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                StartsWith("ran without safety checks: EV travel time -12.4 s"));
    EXPECT_EQ(effect_of(scenario.conditions[1], Measure::emergency_travel_time), Effect::ruled_out);
    EXPECT_EQ(effect_of(scenario.conditions[1], Measure::other_time_loss), Effect::ruled_out);
}

TEST(Effect, on_the_gap_is_ruled_out_as_every_gain_is) {
    ScenarioFacts scenario = tests::scenario("merge");
    ConditionFacts& condition = scenario.conditions[1];
    EXPECT_NE(effect_of(condition, Measure::gap_closed), Effect::ruled_out);
    condition.objections.unchecked = true;
    EXPECT_EQ(effect_of(condition, Measure::gap_closed), Effect::ruled_out);
}

TEST(Verdict, says_how_many_runs_are_missing) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].missing_runs = 2;
    scenario.conditions[1].complete_runs = 5;
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                StartsWith("2 of 7 runs are missing; "));
}

TEST(Verdict, does_not_praise_the_others_time_loss_where_they_never_departed) {
    ScenarioFacts scenario = tests::scenario("merge");
    ConditionFacts& condition = scenario.conditions[1];
    tests::difference(condition, Measure::other_time_loss) = tests::around(-9.0, 2.0);
    EXPECT_THAT(verdict(scenario, condition, Script::plain).text(), HasSubstr("The others lose less time"));
    condition.objections.not_inserted = analysis::Estimate{20, 8.0, 1.0, analysis::Interval{6.0, 10.0}};
    const std::string text = verdict(scenario, condition, Script::plain).text();
    EXPECT_THAT(text, Not(HasSubstr("lose less time")));
    EXPECT_THAT(text, HasSubstr(" More other vehicles not inserted (+8.0 per run [6.0, 10.0])"));
}

TEST(Verdict, tells_the_difference_to_vehicles_that_pass_red_and_the_cost_on_cross_streets) {
    ScenarioFacts scenario = tests::scenario("merge");
    ConditionFacts& condition = scenario.conditions[1];
    EXPECT_EQ(privilege_sentence(scenario, condition, Script::plain), "");
    scenario.conditions[2].condition.policies = {"red_privilege"};
    scenario.conditions[2].title = "They pass red";
    tests::metric(scenario.conditions[2], info(primary).field).values = {50.0, 60.0, 70.0, 61.0, 59.0};
    tests::metric(condition, info(primary).field).values = {44.0, 55.0, 64.0, 55.0, 54.0};
    EXPECT_THAT(privilege_sentence(scenario, condition, Script::plain),
                HasSubstr("Against EVs that pass red (They pass red), s: -5.6 [-6.3, -4.9]."));
    EXPECT_EQ(privilege_sentence(scenario, scenario.conditions[2], Script::plain), "");
    EXPECT_EQ(cross_street_words(condition, Script::plain), "");
    tests::metric(condition, "cross_street_delay_s").comparison.emplace().difference =
        tests::around(28.0, 17.0);
    EXPECT_EQ(cross_street_words(condition, Script::plain),
              "on cross streets +28 vehicle-s [11, 45] a passage of an EV");
    EXPECT_THAT(verdict(scenario, condition, Script::plain).text(), HasSubstr("Lost on cross streets +28"));
    tests::metric(condition, "cross_street_delay_s").comparison->difference = tests::around(28.0, 30.0);
    EXPECT_EQ(cross_street_words(condition, Script::plain), "");
}

TEST(LeaseSentence, names_what_was_asked_or_that_nothing_was) {
    ConditionFacts condition = tests::condition("corridor", "corridor", 74.0);
    condition.condition.policies = {"corridor"};
    condition.leases.clear();
    EXPECT_EQ(lease_sentence(condition), "asked for nothing");
    condition.leases.push_back({"corridor",
                                traffic::LeaseKind::change_lane,
                                1200,
                                5,
                                800,
                                900,
                                {{traffic::Refusal::lockout, 1}, {traffic::Refusal::no_room_beside, 400}}});
    EXPECT_EQ(lease_sentence(condition),
              "corridor: asked a vehicle to change lanes 1,200 times, 800 carried "
              "out, refused at some time: no_room_beside 400, lockout 1");
}

// What is heard is renewed, and what is lost is asked anew.
TEST(LeaseSentence, tells_lost_messages_from_what_was_refused) {
    ScenarioFacts scenario = tests::scenario("merge");
    ConditionFacts& condition = scenario.conditions[1];
    condition.condition.policies = {"Green"};
    condition.leases = {
        {"Green", traffic::LeaseKind::hold_green, 272, 179, 34, 0, {{traffic::Refusal::unheard, 238}}}};
    EXPECT_EQ(lease_sentence(condition),
              "Green: asked a signal for green 34 times, 34 carried out, 238 of 451 messages lost");
    EXPECT_EQ(refusals_sentence(condition), "");
    tests::set_total(condition, "signal_requests_sent", 451);
    tests::set_total(condition, "signal_requests_heard", 213);
    EXPECT_THAT(lease_sentence(condition), testing::EndsWith("238 of 451 messages lost")) << "told once";
    tests::set_total(condition, "signal_requests_sent", 1150);
    tests::set_total(condition, "signal_requests_heard", 558);
    EXPECT_THAT(lease_sentence(condition), testing::EndsWith("; 354 of 699 messages to signals lost"));
    condition.leases.front().acted = 5;
    condition.leases.front().refused[traffic::Refusal::lockout] = 29;
    EXPECT_THAT(refusals_sentence(condition), HasSubstr("Of Green's 34 requests 85 % were never carried out, "
                                                        "mostly refused as lockout"));
}

TEST(Verdict, of_one_replication_claims_nothing) {
    ScenarioFacts scenario = tests::scenario("merge");
    tests::difference(scenario.conditions[1], primary) = analysis::Estimate{1, -12.4, 0.0, {}};
    EXPECT_EQ(verdict(scenario, scenario.conditions[1], Script::plain).text(),
              "no verdict: too few seeds, 1 of at least 5 (EV travel time -12.4 s, -12 %).");
    tests::difference(scenario.conditions[1], Measure::emergency_restricted_time) = {};
    EXPECT_EQ(verdict(scenario, scenario.conditions[1], Script::plain).text(),
              "no verdict: no complete pair of runs.");
}

TEST(Verdict, says_in_how_many_runs_a_part_never_acted) {
    ScenarioFacts scenario = tests::scenario("merge");
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                Not(HasSubstr("Never acted")));
    scenario.conditions[1].idle_parts = {
        {"preempt_signals", 20, 20}, {"clear_lane", 20, 20}, {"recover_signals", 3, 20, 2}};
    EXPECT_THAT(
        verdict(scenario, scenario.conditions[1], Script::plain).text(),
        HasSubstr(
            ". Never acted: preempt_signals, clear_lane in 20 of 20 runs; recover_signals in 3 of 20 runs. "
            "Only changed the EV's own lane: recover_signals in 2 of 20 runs."));
    using traffic::Refusal;
    scenario.conditions[1].idle_parts = {
        {"Rows", 20, 20, 0, 7407, {{Refusal::vehicle_gone, 7407}, {Refusal::lockout, 1}}},
        {"Humans", 20, 20, 0, 90, {{Refusal::not_controllable, 60}}},
        {"Elsewhere", 20, 20, 0, 4, {{Refusal::on_a_junction, 4}, {Refusal::route_elsewhere, 4}}},
        {"Late", 20, 20, 0, 1, {}}};
    EXPECT_THAT(
        verdict(scenario, scenario.conditions[1], Script::plain).text(),
        HasSubstr("Never acted: Rows (7,407 leases, all refused as vehicle_gone, 1 as lockout), Humans (90 "
                  "leases, most refused as not_controllable), Elsewhere (4 leases, all refused as "
                  "on_a_junction, all as route_elsewhere), Late (1 lease, none carried out) in 20 of 20"));
    scenario.conditions[1].idle_parts = {{"Lane", 20, 20, 0, 72, {{Refusal::no_such_lane, 60}}},
                                         {"Row", 20, 20, 0, 9, {{Refusal::no_such_lane, 9}}}};
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                HasSubstr("in 20 of 20 runs. no_such_lane: lane numbers count from the outermost, 0: "
                          "belief.vehicles.lane_number, not lane."));
}

TEST(Verdict, says_that_most_of_a_policys_requests_were_refused_and_what_helps) {
    using traffic::LeaseKind;
    using traffic::Refusal;
    ScenarioFacts scenario = tests::scenario("merge");
    ConditionFacts& condition = scenario.conditions[1];
    const auto text = [&] { return verdict(scenario, condition, Script::plain).text(); };
    condition.leases = {
        {"Mine", LeaseKind::change_lane, 3600, 0, 50, 70, {{Refusal::not_controllable, 3500}}},
        {"Mine", LeaseKind::hold_green, 87, 0, 2, 70, {{Refusal::lockout, 80}}},
        {"Mine", LeaseKind::stand_back, 90000, 0, 0, 0, {{Refusal::stood_back, 90000}}},
        {"Mine", LeaseKind::consider_way, 800, 0, 0, 0, {{Refusal::stood_back, 800}}}};
    EXPECT_THAT(text(), HasSubstr(" Of Mine's 3,687 requests 98 % were never carried out, mostly refused as "
                                  "not_controllable: human drivers; ask only where "
                                  "belief.vehicles.is_automated."));
    condition.leases[0].acted = 1000;
    EXPECT_THAT(text(), Not(HasSubstr("never carried out"))) << "more than a quarter was";
    condition.leases = {{"Few", LeaseKind::hold_green, 19, 0, 1, 0, {{Refusal::lockout, 18}}}};
    EXPECT_THAT(text(), Not(HasSubstr("never carried out")));
}

TEST(Verdict, says_which_condition_has_the_same_runs) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].same_as = scenario.conditions[2].name();
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain).text(),
                HasSubstr(". Every run is identical to that of " + scenario.conditions[2].label() + "."));
    EXPECT_THAT(verdict(scenario, scenario.conditions[2], Script::plain).text(), Not(HasSubstr("identical")));
}

TEST(ConditionLabel, says_who_knows_the_truth) {
    ConditionFacts facts = tests::condition("ceiling", "ceiling", 90.0);
    EXPECT_EQ(facts.label(), "ceiling");
    facts.knows_truth = true;
    EXPECT_EQ(facts.label(), "ceiling (knows the truth)");
}

TEST(Headline, counts_conditions_by_effect) {
    EXPECT_EQ(
        headline(tests::study({"merge"})),
        "merge: emergency vehicles faster under 2 of 4 conditions, slower under 1, no effect shown under 1.");
    EXPECT_EQ(headline(StudyFacts{}), "No condition was compared with a baseline.");
}

TEST(Headline, counts_lost_emergency_vehicles_first) {
    StudyFacts study = tests::study({"merge"});
    study.scenarios[0] = survivors_only();
    EXPECT_EQ(
        headline(study),
        "merge: emergency vehicles lost under 1 of 4 conditions, emergency vehicles faster under 2, slower "
        "under 1.");
}

TEST(Headline, does_not_speak_of_gains_where_none_is_shown) {
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        if (condition.is_compared()) {
            tests::difference(condition, Measure::emergency_restricted_time) = tests::around(-1.0, 3.0);
        }
    }
    EXPECT_EQ(headline(study), "merge: no effect shown under 4 of 4 conditions.");
    EXPECT_THAT(headline(study), Not(HasSubstr("faster")));
}

}  // namespace
}  // namespace clearway::report
