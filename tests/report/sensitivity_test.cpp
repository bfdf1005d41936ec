#include "report/sensitivity.hpp"

#include <sstream>

#include <gmock/gmock.h>

#include "report/console.hpp"
#include "report/html.hpp"
#include "report/sample.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// A corridor with settings; EV time and others' time loss by replication.
analysis::ConditionSummary condition(const core::Settings& settings, const analysis::Values& emergency,
                                     const analysis::Values& others) {
    analysis::ConditionSummary summary;
    summary.condition.policies = {"corridor"};
    summary.condition.name = settings.empty() ? "corridor" : "corridor+" + settings.begin()->first;
    summary.condition.settings = settings;
    for (const analysis::MetricInfo& info : analysis::all_metrics()) {
        analysis::MetricSummary metric;
        metric.metric = info;
        metric.values.assign(emergency.size(), std::nullopt);
        if (info.name == "emergency_restricted_travel_time_s") metric.values = emergency;
        if (info.name == "others_time_loss_s") metric.values = others;
        summary.metrics.push_back(std::move(metric));
    }
    return summary;
}

analysis::Summary turned_summary(std::vector<analysis::ConditionSummary> conditions) {
    analysis::Summary summary;
    summary.scenarios.push_back({"city", "City", std::move(conditions)});
    return summary;
}

analysis::Summary three_settings() {
    return turned_summary(
        {condition({}, {100, 102, 104, 106, 108}, {40, 40, 40, 40, 40}),
         condition({{"a.small", "1"}}, {101, 103, 105, 107, 109}, {40, 40, 40, 40, 40}),
         condition({{"a.large", "5"}}, {90, 92, 94, 96, 98}, {42, 42, 42, 42, 42}),
         condition({{"a.large", "9"}}, {103, 105, 107, 109, 111}, {39, 39, 39, 39, 39}),
         condition({{"a.large", "9"}, {"a.small", "1"}}, {1, 1, 1, 1, 1}, {1, 1, 1, 1, 1})});
}

TEST(Sensitivities, put_the_setting_that_moves_emergency_vehicles_most_first) {
    const auto all = sensitivities(three_settings());
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0].condition, "corridor");
    ASSERT_EQ(all[0].rows.size(), 2U);
    EXPECT_EQ(all[0].rows[0].setting, "a.large");
    EXPECT_EQ(all[0].rows[1].setting, "a.small");
    ASSERT_EQ(all[0].rows[0].levels.size(), 2U);
    EXPECT_NEAR(all[0].rows[0].levels[0].emergency->mean, -10.0, 1e-9);
    EXPECT_NEAR(all[0].rows[0].levels[0].others->mean, 2.0, 1e-9);
    EXPECT_NEAR(all[0].rows[0].levels[1].emergency->mean, 3.0, 1e-9);
    EXPECT_NEAR(all[0].rows[0].reach_s(), 10.0, 1e-9);
}

TEST(Sensitivities, need_two_settings_turned_and_the_condition_with_none) {
    auto summary = three_settings();
    summary.scenarios[0].conditions.erase(summary.scenarios[0].conditions.begin());
    EXPECT_TRUE(sensitivities(summary).empty());
    auto one = three_settings();
    one.scenarios[0].conditions.erase(one.scenarios[0].conditions.begin() + 1);
    EXPECT_TRUE(sensitivities(one).empty());
}

TEST(Sensitivities, leave_controls_out) {
    const auto summary = three_settings();
    const std::string control = summary.scenarios[0].conditions[1].condition.name;
    EXPECT_TRUE(sensitivities(summary, {{control, "corridor"}}).empty()) << "one setting is left";
}

TEST(Sensitivities, do_not_mix_conditions_of_another_recipe) {
    auto summary = three_settings();
    summary.scenarios[0].conditions[1].condition.failure = "B10";
    EXPECT_TRUE(sensitivities(summary).empty());
}

TEST(Sensitivities, are_printed_within_80_columns_and_drawn_in_the_page) {
    const auto all = sensitivities(three_settings());
    const std::string table = sensitivity_table(all, SensitivityRows::all);
    EXPECT_THAT(table, HasSubstr("a.large\n  5 "));
    EXPECT_THAT(table, HasSubstr("-10.0"));
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 80U) << line;
    StudyFacts study;
    study.sensitivities = all;
    std::ostringstream page;
    write_html(study, page);
    EXPECT_THAT(page.str(), HasSubstr("Sensitivity to each setting"));
    EXPECT_THAT(page.str(), HasSubstr("class=\"beam s1\""));
    EXPECT_THAT(page.str(), ContainsRegex("class=.beam s1. x=.[1-9][0-9.]*. y=.[0-9.]+. width=.[1-9]"));
    std::ostringstream empty;
    write_html(StudyFacts{}, empty);
    EXPECT_THAT(empty.str(), Not(HasSubstr("Sensitivity to each setting")));
}

/// The setting `preempt_signals.lead_s` moves EVs, `clear_lane.worth_s` moves nobody for certain.
std::vector<Sensitivity> one_that_matters() {
    const analysis::Values others = {40, 40, 40, 40, 40};
    return sensitivities(
        turned_summary({condition({}, {100, 102, 104, 106, 108}, others),
                        condition({{"preempt_signals.lead_s", "4"}}, {90, 92, 94, 96, 97}, others),
                        condition({{"clear_lane.worth_s", "2"}}, {101, 101, 105, 105, 108}, others)}));
}

TEST(Sensitivities, fold_settings_without_a_shown_effect_and_count_them) {
    const auto all = one_that_matters();
    ASSERT_EQ(all.size(), 1U);
    EXPECT_TRUE(all[0].rows[0].changes(&SensitivityLevel::emergency));
    EXPECT_FALSE(all[0].rows[0].changes(&SensitivityLevel::others));
    EXPECT_FALSE(all[0].rows[0].shows_nothing());
    EXPECT_TRUE(all[0].rows[1].shows_nothing());
    const std::string table = sensitivity_table(all, SensitivityRows::with_effect);
    EXPECT_THAT(table, HasSubstr("preempt_signals.lead_s\n  8 -> 4 "));
    EXPECT_THAT(table, Not(HasSubstr("clear_lane.worth_s")));
    EXPECT_THAT(table, HasSubstr("1 setting without a shown effect"));
    EXPECT_THAT(sensitivity_table(all, SensitivityRows::all), HasSubstr("clear_lane.worth_s"));
    StudyFacts study;
    study.sensitivities = all;
    std::ostringstream stream;
    write_html(study, stream);
    const std::string page = stream.str();
    const std::size_t fold = page.find("<details class=\"fold\"><summary>1 setting without a shown effect");
    ASSERT_NE(fold, std::string::npos);
    EXPECT_LT(page.find(">preempt_signals.lead_s</text>"), fold);
    EXPECT_GT(page.find(">clear_lane.worth_s</text>"), fold);
    EXPECT_THAT(page, HasSubstr(">8 \u2192 4</text>"));
}

TEST(Sensitivities, name_what_is_objected_to_a_level) {
    auto all = one_that_matters();
    SensitivityRow& harmless = all[0].rows.back();
    ASSERT_TRUE(harmless.shows_nothing());
    harmless.levels[0].objection = "lost EVs";
    EXPECT_FALSE(harmless.shows_nothing()) << "it is not folded away";
    EXPECT_THAT(sensitivity_table(all, SensitivityRows::with_effect), HasSubstr(", lost EVs  "));
    StudyFacts study;
    study.sensitivities = all;
    EXPECT_THAT(json_tables(study), HasSubstr("\"objection\": \"lost EVs\""));
    std::ostringstream stream;
    write_html(study, stream);
    EXPECT_THAT(stream.str(), HasSubstr(" (!)</text>"));
}

TEST(Sensitivities, do_not_fold_what_too_few_seeds_cannot_tell) {
    const auto all = sensitivities(turned_summary({condition({}, {100, 102}, {40, 40}),
                                                   condition({{"a.small", "1"}}, {100, 103}, {40, 41}),
                                                   condition({{"a.large", "5"}}, {90, 91}, {42, 42})}));
    ASSERT_EQ(all.size(), 1U);
    for (const SensitivityRow& row : all[0].rows) {
        EXPECT_FALSE(row.shows_nothing());
        EXPECT_FALSE(row.changes(&SensitivityLevel::emergency));
    }
    EXPECT_THAT(sensitivity_sentence(all[0]), HasSubstr("fewer than 5 seeds"));
}

TEST(Sensitivities, name_the_shipped_value_where_it_does_not_depend_on_the_scenario) {
    const SensitivityRow known{"preempt_signals.lead_s", "8", {}};
    EXPECT_EQ(known.turned({"", "16", {}, {}, ""}, "->"), "8 -> 16");
    const SensitivityRow unknown{"a.small", "", {}};
    EXPECT_EQ(unknown.turned({"", "1", {}, {}, ""}, "->"), "1");
    EXPECT_EQ(one_that_matters()[0].rows[0].shipped, "8");
    EXPECT_EQ(sensitivities(three_settings())[0].rows[0].shipped, "");
}

/// A compared condition whose EVs are faster by 12 s.
ConditionFacts helpful(const std::string& name) {
    ConditionFacts facts = tests::empty_condition(name, name);
    facts.baseline = "baseline";
    facts.complete_runs = 5;
    tests::difference(facts, primary) = tests::around(-12.0, 2.0, 5);
    return facts;
}

TEST(Sensitivities, come_before_the_verdicts_of_their_levels_which_are_folded) {
    StudyFacts study;
    study.sensitivities = one_that_matters();
    ConditionFacts dangerous = helpful("corridor+clear_lane.worth_s");
    tests::difference(dangerous, Measure::collisions) = tests::around(2.0, 1.0, 5);
    ScenarioFacts city;
    city.name = "city";
    city.replications = 5;
    city.conditions = {tests::empty_condition("baseline", "baseline"), helpful("corridor"),
                       helpful("corridor+preempt_signals.lead_s"), dangerous};
    study.scenarios = {city};
    EXPECT_EQ(headline(study),
              "city: EV travel time is changed by 1 of 2 settings of corridor, each turned alone, and the "
              "others' time loss by 0 (the 95 % interval of a paired difference excludes 0). city: emergency "
              "vehicles faster under 1 of 1 condition.");
    std::ostringstream stream;
    write_html(study, stream);
    const std::string page = stream.str();
    const std::size_t fold = page.find("<details class=\"fold\"><summary>1 condition with a setting turned");
    ASSERT_NE(fold, std::string::npos);
    EXPECT_GT(page.find("<dt>corridor+preempt_signals.lead_s</dt>"), fold);
    EXPECT_LT(page.find("<dt>corridor+clear_lane.worth_s</dt>"), fold) << "more collisions are never folded";
    EXPECT_LT(page.find("<section id=\"sensitivity\">"), page.find("<section id=\"tables\">"));
    const std::string console = console_tables(study, Tables::essential);
    EXPECT_THAT(console, testing::StartsWith("city: EV travel time is changed by 1 of 2 settings"));
    EXPECT_THAT(console, Not(HasSubstr("corridor+preempt_signals.lead_s: helped")));
    EXPECT_THAT(console, HasSubstr("corridor+clear_lane.worth_s: helped"));
    EXPECT_THAT(console_tables(study, Tables::all), HasSubstr("corridor+preempt_signals.lead_s: helped"));
}

}  // namespace
}  // namespace clearway::report
