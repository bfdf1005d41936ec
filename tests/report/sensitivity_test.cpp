#include "report/sensitivity.hpp"

#include <sstream>

#include <gmock/gmock.h>

#include "report/html.hpp"

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

analysis::Summary summary_of(std::vector<analysis::ConditionSummary> conditions) {
    analysis::Summary summary;
    summary.scenarios.push_back({"city", "City", std::move(conditions)});
    return summary;
}

analysis::Summary three_settings() {
    return summary_of({condition({}, {100, 102, 104, 106, 108}, {40, 40, 40, 40, 40}),
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

TEST(Sensitivities, do_not_mix_conditions_of_another_recipe) {
    auto summary = three_settings();
    summary.scenarios[0].conditions[1].condition.failure = "B10";
    EXPECT_TRUE(sensitivities(summary).empty());
}

TEST(Sensitivities, are_printed_within_80_columns_and_drawn_in_the_page) {
    const auto all = sensitivities(three_settings());
    const std::string table = sensitivity_table(all);
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

}  // namespace
}  // namespace clearway::report
