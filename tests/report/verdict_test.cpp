#include "report/verdict.hpp"

#include <gmock/gmock.h>

#include "report/sample.hpp"

namespace clearway::report {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Outcome differing(const Estimate& difference, double least_relevant = 0.0) {
    return {{}, difference, least_relevant, {}};
}

TEST(Effect, of_less_than_what_counts_is_negligible) {
    EXPECT_EQ(effect_of(differing({-0.2, -0.3, -0.1, 20}, 1.0), Better::lower), Effect::negligible);
    EXPECT_EQ(effect_of(differing({0.1, -0.3, 0.5, 20}, 1.0), Better::lower), Effect::negligible)
        << "shown to be smaller than what counts";
    EXPECT_EQ(effect_of(differing({-0.9, -1.7, -0.1, 20}, 1.0), Better::lower), Effect::negligible);
    EXPECT_EQ(effect_of(differing({-1.2, -1.7, -0.7, 20}, 1.0), Better::lower), Effect::better);
    EXPECT_EQ(effect_of(differing({-0.2, -2.0, 1.6, 20}, 1.0), Better::lower), Effect::none_shown);
}

TEST(Effect, follows_from_the_interval_alone) {
    EXPECT_EQ(effect_of(differing({-5.0, -9.0, -1.0, 20}), Better::lower), Effect::better);
    EXPECT_EQ(effect_of(differing({-5.0, -9.0, -1.0, 20}), Better::higher), Effect::worse);
    EXPECT_EQ(effect_of(differing({5.0, 1.0, 9.0, 20}), Better::lower), Effect::worse);
    EXPECT_EQ(effect_of(differing({5.0, 1.0, 9.0, 20}), Better::higher), Effect::better);
    EXPECT_EQ(effect_of(differing({-5.0, -11.0, 1.0, 20}), Better::lower), Effect::none_shown);
}

TEST(Effect, counts_a_bound_of_zero_as_included) {
    EXPECT_EQ(effect_of(differing({-5.0, -10.0, 0.0, 20}), Better::lower), Effect::none_shown);
    EXPECT_EQ(effect_of(differing({0.0, 0.0, 0.0, 20}), Better::lower), Effect::none_shown);
}

TEST(Effect, of_a_single_pair_is_undecided) {
    EXPECT_EQ(effect_of(differing({-50.0, std::nullopt, std::nullopt, 1}), Better::lower), Effect::undecided);
}

TEST(Verdict, says_helped_harmed_or_no_effect_shown) {
    const ScenarioFacts scenario = tests::scenario("merge");
    EXPECT_EQ(verdict(scenario, scenario.conditions[1], Script::plain),
              "helped: EV travel time -12.4 s [-15.5, -9.3], -12 %; no effect shown on the others' time loss "
              "(+0.4 s "
              "[-0.8, 1.6]).");
    EXPECT_EQ(
        verdict(scenario, scenario.conditions[3], Script::plain),
        "harmed: EV travel time +29.5 s [21.0, 38.0], +29 %; the others lose more time (+3.9 s [1.7, 6.1]).");
    EXPECT_THAT(verdict(scenario, scenario.conditions[4], Script::plain),
                StartsWith("no effect shown: EV travel time -0.6 s [-3.4, 2.2], -1 %;"));
}

TEST(Verdict, does_not_call_a_fifth_of_a_second_help) {
    ScenarioFacts scenario = tests::scenario("merge");
    Outcome& outcome = scenario.conditions[1].outcome(Measure::emergency_travel_time);
    outcome.difference = tests::around(-0.2, 0.1);
    outcome.least_relevant = 1.0;
    EXPECT_THAT(
        verdict(scenario, scenario.conditions[1], Script::plain),
        StartsWith("no relevant effect: EV travel time -0.2 s [-0.3, -0.1], 0 %, where 1.0 s would count;"));
}

TEST(Verdict, names_collisions_when_their_interval_excludes_zero) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].outcome(Measure::collisions).difference = tests::around(4.5, 1.5);
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain),
                EndsWith("; more collisions (+4.50 per run [3.00, 6.00])."));
}

TEST(Verdict, says_that_safety_checks_were_off) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].safety_checks_off = true;
    EXPECT_THAT(verdict(scenario, scenario.conditions[1], Script::plain), HasSubstr("Safety checks"));
}

TEST(Verdict, of_one_replication_claims_nothing) {
    ScenarioFacts scenario = tests::scenario("merge");
    scenario.conditions[1].outcome(Measure::emergency_travel_time).difference = {-12.4, std::nullopt,
                                                                                 std::nullopt, 1};
    EXPECT_EQ(verdict(scenario, scenario.conditions[1], Script::plain),
              "no verdict: one pair of runs has no interval (EV travel time -12.4 s, -12 %).");
    scenario.conditions[1].outcome(Measure::emergency_travel_time).difference = {};
    EXPECT_EQ(verdict(scenario, scenario.conditions[1], Script::plain),
              "no verdict: no complete pair of runs.");
}

TEST(Headline, counts_conditions_by_effect) {
    EXPECT_EQ(headline(tests::study({"merge"})),
              "merge: EVs faster under 2 of 4 conditions, slower under 1, no effect shown under 1.");
    EXPECT_EQ(headline(StudyFacts{}), "No condition was compared with a baseline.");
}

TEST(Headline, does_not_speak_of_gains_where_none_is_shown) {
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& condition : study.scenarios[0].conditions) {
        if (condition.is_compared()) {
            condition.outcome(Measure::emergency_travel_time).difference = tests::around(-1.0, 3.0);
        }
    }
    EXPECT_EQ(headline(study), "merge: no effect shown under 4 of 4 conditions.");
    EXPECT_THAT(headline(study), Not(HasSubstr("faster")));
}

}  // namespace
}  // namespace clearway::report
