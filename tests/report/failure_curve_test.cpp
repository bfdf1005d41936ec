#include "report/failure_curve.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "report/console.hpp"
#include "report/html.hpp"
#include "report/page.hpp"

namespace clearway::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

analysis::Estimate around(double mean, double half_width) {
    return {20, mean, 1.0, analysis::Interval{mean - half_width, mean + half_width}};
}

/// A condition whose EV travel time differs from the baseline's by `difference`, with links of quality `f1`.
analysis::ConditionSummary condition(const std::string& failure, const std::string& predictor,
                                     const analysis::Estimate& difference, double f1,
                                     const std::string& policy = "dissertation") {
    analysis::ConditionSummary summary;
    summary.condition.name = predictor + failure;
    summary.condition.failure = failure;
    summary.condition.predictor = predictor;
    summary.condition.policies = {policy};
    summary.baseline = "baseline";
    for (const analysis::MetricInfo& info : analysis::all_metrics()) {
        analysis::MetricSummary metric;
        metric.metric = info;
        if (info.name == "links_f1") metric.estimate = around(f1, 0.01);
        if (info.name == analysis::primary_metric) {
            metric.comparison.emplace();
            metric.comparison->difference = difference;
        }
        summary.metrics.push_back(std::move(metric));
    }
    return summary;
}

analysis::Summary summary_of(std::vector<analysis::ConditionSummary> conditions) {
    analysis::Summary summary;
    summary.scenarios.push_back({"city", "City", std::move(conditions)});
    return summary;
}

analysis::Summary three_shares() {
    return summary_of({condition("dark_share=0.9,mean_outage_s=10", "kalman", around(-0.5, 1.0), 0.4),
                       condition("dark_share=0,mean_outage_s=10", "kalman", around(-9.0, 2.0), 1.0),
                       condition("dark_share=0.5,mean_outage_s=10", "kalman", around(-4.0, 3.9), 0.8),
                       condition("dark_share=0,mean_outage_s=10", "none", around(-9.0, 2.0), 1.0),
                       condition("dark_share=0.5,mean_outage_s=10", "none", around(1.0, 0.5), 0.3),
                       condition("perfect", "none", around(-10.0, 2.0), 1.0),
                       condition("perfect", "none", around(-99.0, 2.0), 1.0, "corridor"),
                       condition("B10", "none", around(-99.0, 2.0), 1.0)});
}

TEST(FailureCurves, GroupConditionsByPolicyAndRepairInOrderOfTheShare) {
    const auto curves = failure_curves(three_shares());
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].scenario, "city");
    EXPECT_EQ(curves[0].policy, "dissertation");
    EXPECT_EQ(curves[0].failure, "mean_outage_s=10");
    ASSERT_EQ(curves[0].lines.size(), 3u);
    EXPECT_EQ(curves[0].lines[0].repair, "kalman");
    EXPECT_EQ(curves[0].lines[1].repair, "none");
    EXPECT_EQ(curves[0].lines[2].repair, "perfect");
    std::vector<double> shares;
    for (const FailurePoint& point : curves[0].lines[0].points) {
        shares.push_back(point.dark_share);
    }
    EXPECT_THAT(shares, ElementsAre(0.0, 0.5, 0.9));
    EXPECT_EQ(curves[0].lines[0].points[1].travel_time->mean, -4.0);
    EXPECT_EQ(curves[0].lines[0].points[1].link_f1->mean, 0.8);
    EXPECT_EQ(curves[0].lines[2].points.size(), 3u) << "perfect stands at every share";
    EXPECT_EQ(curves[0].lines[2].points[2].travel_time->mean, -10.0);
}

TEST(FailureCurves, BreakEvenWhereTheIntervalFirstReachesZero) {
    const auto curves = failure_curves(three_shares());
    EXPECT_EQ(curves[0].lines[0].break_even, 2u) << "-4 +- 3.9 is still a benefit";
    EXPECT_EQ(curves[0].lines[1].break_even, 1u) << "harm is no benefit";
    EXPECT_FALSE(curves[0].lines[2].break_even.has_value());
}

TEST(FailureCurves, ShowNoBenefitWithoutAnInterval) {
    analysis::Estimate single;
    single.n = 1;
    single.mean = -5.0;
    const auto curves = failure_curves(summary_of(
        {condition("dark_share=0", "none", single, 1.0), condition("dark_share=0.5", "none", single, 0.5)}));
    EXPECT_EQ(curves[0].lines[0].break_even, 0u);
}

TEST(FailureCurves, ShowNoBenefitWhereEmergencyVehiclesAreLost) {
    analysis::ConditionSummary loses = condition("dark_share=0", "none", around(-9.0, 2.0), 1.0);
    loses.objections.emergency = {.arrived = 7, .teleported = 13};
    loses.objections.baseline_emergency = {.arrived = 20};
    const auto curves =
        failure_curves(summary_of({loses, condition("dark_share=0.5", "none", around(-9.0, 2.0), 0.5)}));
    EXPECT_EQ(curves[0].lines[0].break_even, 0u);
    EXPECT_THAT(failure_table(curves), HasSubstr("lost EVs*\n"));
}

TEST(FailureCurves, SayNothingOfLinksWhereThePolicyActsOnPlaces) {
    const auto curves = failure_curves(
        summary_of({condition("dark_share=0", "none", around(-9.0, 2.0), 1.0, "clear_lane"),
                    condition("dark_share=0.5", "none", around(-9.0, 2.0), 0.5, "clear_lane")}));
    for (const FailurePoint& point : curves[0].lines[0].points)
        EXPECT_FALSE(point.link_f1.has_value());
}

TEST(FailureCurves, AreLeftOutBelowTwoShares) {
    EXPECT_TRUE(failure_curves(summary_of({condition("dark_share=0.3", "none", around(0, 1), 1.0),
                                           condition("B10", "none", around(0, 1), 1.0)}))
                    .empty());
    EXPECT_TRUE(failure_curves(summary_of({condition("dark_share=x", "none", around(0, 1), 1.0),
                                           condition("dark_share=y", "none", around(0, 1), 1.0)}))
                    .empty());
}

TEST(FailureCurves, StandInTheTableInJsonAndOnThePage) {
    StudyFacts study;
    study.failure_curves = failure_curves(three_shares());
    const std::string table = console_tables(study);
    EXPECT_THAT(table,
                HasSubstr("Benefit against failure: city, policy dissertation; failure mean_outage_s=10"));
    EXPECT_THAT(table, HasSubstr("-4.0 [-7.9, -0.1]"));
    EXPECT_THAT(table, HasSubstr("0.400 [0.390, 0.410]"));
    EXPECT_THAT(table, HasSubstr("not shown*\n"));
    const auto json = nlohmann::json::parse(json_tables(study));
    const auto& repairs = json.at("failure_curves").at(0).at("repairs");
    EXPECT_EQ(repairs.at(0).at("break_even_dark_share"), 0.9);
    EXPECT_EQ(repairs.at(0).at("points").at(1).at("emergency_restricted_travel_time_difference_s").at("mean"),
              -4.0);
    EXPECT_TRUE(repairs.at(2).at("break_even_dark_share").is_null());
    std::ostringstream page;
    write_html(study, page);
    EXPECT_THAT(page.str(), HasSubstr("<section id=\"failure\">"));
    EXPECT_THAT(page.str(), HasSubstr("across: time dark, %"));
    EXPECT_THAT(page.str(), HasSubstr("Break-even"));
}

TEST(FailureCurves, EscapeNamesFromFiles) {
    StudyFacts study;
    study.failure_curves = failure_curves(three_shares());
    study.failure_curves[0].scenario = "<script>\x1b[2J";
    EXPECT_THAT(tests::without_script(tests::page_of(study)), ::testing::Not(HasSubstr("<script>")));
    EXPECT_THAT(console_tables(study), ::testing::Not(HasSubstr("\x1b")));
}

TEST(FailureCurves, AreNotThereForOtherStudies) {
    EXPECT_EQ(failure_table({}), "");
    EXPECT_FALSE(nlohmann::json::parse(json_tables({})).contains("failure_curves"));
    std::ostringstream page;
    write_html({}, page);
    EXPECT_THAT(page.str(), ::testing::Not(HasSubstr("id=\"failure\"")));
}

}  // namespace
}  // namespace clearway::report
