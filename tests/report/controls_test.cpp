// What a condition is worth without a part of it, and what a failure costs it.

#include "report/controls.hpp"

#include <gmock/gmock.h>

#include "experiment/related_conditions.hpp"
#include "report/overview_fixture.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::around;
using tests::Overview;

/// `corridor` and two conditions in which a part of it is off.
class Controls : public Overview {
  protected:
    Controls() {
        corridor().least_relevant_s = 1.0;
        for (const char* const name : {"deaf", "blind"}) {
            scenario_.conditions.push_back(tests::condition(name, name, 70.0));
            tests::compare(scenario_.conditions.back(), around(-30.0, 4.0), around(4.6, 1.0));
            scenario_.conditions.back().control_of = "corridor";
        }
        set(corridor(), {70.0, 74.0, 75.0, 76.0, 75.0});
        set(scenario_.conditions[2], {82.0, 87.0, 86.0, 89.0, 86.0});
        set(scenario_.conditions[3], {71.0, 73.0, 77.0, 73.0, 76.0});
        study_.scenarios = {scenario_};
    }
    static void set(ConditionFacts& facts, const analysis::Values& values) {
        tests::metric(facts, info(primary).field).values = values;
    }
    std::string sentence() { return controls_sentence(scenario_, corridor(), Script::plain); }
};

TEST_F(Controls, tell_what_a_part_is_worth) {
    EXPECT_EQ(sentence(),
              "Controls: with one part of it off, EV travel time changes by, s: deaf: +12.0 [10.8, 13.2]; "
              "blind: 0.0 [-2.5, 2.5], no difference shown.");
    EXPECT_THAT(verdict(scenario_, corridor(), Script::plain).text(), HasSubstr(sentence()));
    EXPECT_EQ(controls_sentence(scenario_, scenario_.conditions[2], Script::plain), "")
        << "a control has none";
    EXPECT_EQ(controls_note(scenario_, corridor(), Script::plain), sentence());
    EXPECT_EQ(controls_note(scenario_, scenario_.conditions[0], Script::plain), "corridor: " + sentence());
}

TEST_F(Controls, tell_a_part_that_harms_one_that_never_acts_objections_and_too_few_pairs) {
    set(scenario_.conditions[2], {60.0, 65.0, 64.0, 67.0, 64.0});
    scenario_.conditions[3].same_as = "baseline";
    EXPECT_THAT(sentence(),
                testing::EndsWith("deaf: -10.0 [-11.2, -8.8]; blind: every run is that of the baseline."));
    set(scenario_.conditions[2], {70.0, 74.1, 75.2, 76.1, 75.0});
    scenario_.conditions[2].objections.emergency = {.arrived = 17, .teleported = 3};
    scenario_.conditions[2].objections.baseline_emergency = {.arrived = 20};
    scenario_.conditions[3].same_as.clear();
    set(scenario_.conditions[3], {71.0, 73.0});
    EXPECT_THAT(sentence(),
                testing::EndsWith("deaf (lost EVs): +0.1 [0.0, 0.2], a mean below what counts, the same EV "
                                  "times in 2 of 5 runs; blind: 0.0, no verdict."));
}

TEST_F(Controls, say_what_a_failure_costs_and_where_it_changes_nothing) {
    corridor().condition.failure = "B40";
    scenario_.conditions[2].condition = experiment::without_failure(corridor().condition);
    scenario_.conditions[3].condition.policies = {"clear_lane"};
    set(scenario_.conditions[2], {70.0, 74.0, 73.0, 74.0, 75.0});
    tests::compare(scenario_.conditions[2], around(-24.0, 3.0), around(0.0, 1.0));
    EXPECT_EQ(emergency().details.front(), "-24.0 [-27.0, -21.0] s while nothing fails");
    const auto failing = [&] { return failing_sentence(scenario_, corridor(), Script::plain); };
    EXPECT_EQ(failing(),
              "What failing costs: EV travel time against the same while nothing fails, s: +0.8 [-0.6, 2.2], "
              "no difference shown, the same EV times in 3 of 5 runs.");
    EXPECT_THAT(sentence(), Not(HasSubstr("nothing fails"))) << "told once";
    tests::compare(scenario_.conditions[2], around(-2.0, 3.0), around(0.0, 1.0));
    EXPECT_THAT(failing(), HasSubstr("+0.8 [-0.6, 2.2], but no gain is shown that could be lost, the same"));
    tests::compare(scenario_.conditions[2], around(-24.0, 3.0), around(0.0, 1.0));
    EXPECT_THAT(failing(), Not(HasSubstr("Reports come"))) << "no cost is shown";
    set(scenario_.conditions[2], {60.0, 64.0, 63.0, 64.0, 65.0});
    EXPECT_THAT(failing(), AllOf(HasSubstr("Reports come every 1 s there, else at every step"),
                                 Not(HasSubstr("doubtful"))));
    scenario_.conditions[2].objections.emergency = {.arrived = 17, .teleported = 3};
    scenario_.conditions[2].objections.baseline_emergency = {.arrived = 20};
    EXPECT_THAT(failing(), HasSubstr("s: cannot be said, as while nothing fails it lost 3 of 20"));
    EXPECT_THAT(scenario_headline(scenario_, corridor(), Script::plain),
                AllOf(testing::StartsWith("While nothing fails, "), HasSubstr("no gain can be claimed. ")));
    EXPECT_EQ(emergency().tone, Tile::Tone::neutral);
    corridor().same_as = "corridor_perfect";
    EXPECT_THAT(failing(), HasSubstr("s: every run is the same."));
}

TEST_F(Controls, doubt_a_cost_of_failing_that_is_one_of_many) {
    corridor().condition.failure = "B40";
    scenario_.conditions[2].condition = experiment::without_failure(corridor().condition);
    set(scenario_.conditions[2], {64.0, 71.0, 73.0, 70.0, 74.0});
    const auto failing = [&] { return failing_sentence(scenario_, corridor(), Script::plain); };
    EXPECT_THAT(failing(), AllOf(HasSubstr("s: +3.6 ["), Not(HasSubstr("doubtful"))));
    for (const char* const failure : {"B10", "B20", "B70"}) {
        ConditionFacts other = tests::condition(failure, failure, 70.0);
        other.condition = corridor().condition;
        other.condition.name = other.condition.failure = failure;
        set(other, {66.0, 70.0, 75.0, 69.0, 74.0});
        scenario_.conditions.push_back(other);
    }
    EXPECT_THAT(failing(), ContainsRegex("s: \\+3.6 \\[[^]]*\\] \\(doubtful: p 0\\.[0-9]+ after Holm's "
                                         "correction\\)"));
}

TEST_F(Controls, are_neither_featured_nor_counted) {
    EXPECT_EQ(featured_condition(study_, study_.scenarios[0])->name(), "corridor") << "they gain more";
    EXPECT_EQ(among_conditions(study_, study_.scenarios[0]), "");
    EXPECT_EQ(report::headline(study_), "city: emergency vehicles faster under 1 of 1 condition.");
}

}  // namespace
}  // namespace clearway::report
