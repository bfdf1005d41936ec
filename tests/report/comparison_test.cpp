#include "report/comparison.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace clearway::report {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A condition whose metrics all differ from the baseline's by `mean`, half width 1.
analysis::Summary summary_with(double mean) {
    analysis::ConditionSummary baseline;
    baseline.condition.name = "baseline";
    analysis::ConditionSummary treated;
    treated.condition.name = "treated\x1b[2J";
    treated.baseline = "baseline";
    for (const analysis::MetricInfo& info : analysis::all_metrics()) {
        analysis::MetricSummary metric;
        metric.metric = info;
        baseline.metrics.push_back(metric);
        analysis::Comparison& comparison = metric.comparison.emplace();
        comparison.complete_pairs = 18;
        comparison.incomplete_pairs = 2;
        comparison.difference = analysis::Estimate{18, mean, 2.0, analysis::Interval{mean - 1.0, mean + 1.0}};
        comparison.holm_p = 0.0001;
        comparison.wilcoxon_p = 0.25;
        treated.metrics.push_back(metric);
    }
    analysis::Summary summary;
    summary.scenarios = {{"city", "City", {baseline, treated}}};
    return summary;
}

std::vector<Shortfall> shortfalls_of(double mean, const char* metric, double tolerance) {
    return shortfalls(summary_with(mean), {{metric, tolerance}});
}

/// Two of eighteen pairs locked, and the baseline did in three runs.
analysis::Summary locked_summary() {
    analysis::Summary summary = summary_with(-20.0);
    std::vector<analysis::ConditionSummary>& conditions = summary.scenarios[0].conditions;
    for (analysis::ConditionSummary& condition : conditions)
        for (analysis::MetricSummary& metric : condition.metrics) {
            if (metric.metric.name == "locks") metric.values = {1.0, 0.0, 1.0, 2.0};
            if (metric.metric.name == "longest_lock_s") metric.values = {310.0, 0.0, 90.0, 70.0};
            if (!metric.comparison) continue;
            metric.comparison->locked_pairs = 2;
            metric.comparison->median = -18.5;
            metric.comparison->unlocked =
                analysis::Estimate{16, -19.0, 0.5, analysis::Interval{-19.5, -18.5}};
        }
    conditions[0].complete_runs = 20;
    return summary;
}

TEST(Locks, AreToldByConditionAndBesideTheMeanThatTheyDecide) {
    const std::string text = comparison_text(locked_summary(), {"emergency_travel_time_s"});
    EXPECT_THAT(text, HasSubstr("city: baseline: 4 locks in 3 of 20 runs, the longest 310 s; 0 vehicles"));
    EXPECT_THAT(text,
                HasSubstr("mean -20.0, median of pairs -18.5, mean of the 16 pairs without a lock -19.0\n"
                          "    [-19.5, -18.5]; replications for +-1: 18, without locks 10"));
    EXPECT_THAT(comparison_text(summary_with(-20.0), {"emergency_travel_time_s"}),
                testing::Not(HasSubstr("lock")));
    analysis::Summary all_locked = locked_summary();
    for (analysis::MetricSummary& metric : all_locked.scenarios[0].conditions[1].metrics)
        if (metric.comparison) metric.comparison->locked_pairs = metric.comparison->complete_pairs;
    EXPECT_THAT(comparison_text(all_locked, {"emergency_travel_time_s"}),
                HasSubstr("mean -20.0, median of pairs -18.5; no pair is without a lock"));
    for (analysis::MetricSummary& metric : all_locked.scenarios[0].conditions[1].metrics)
        if (metric.comparison) metric.comparison->locked_pairs = metric.comparison->complete_pairs - 1;
    for (analysis::MetricSummary& metric : all_locked.scenarios[0].conditions[0].metrics) {
        if (metric.metric.name == "locks") metric.values = {1.0, 0.0, 0.0, 0.0};
        if (metric.metric.name == "longest_lock_s") metric.values = {78.0, 0.0, 0.0, 0.0};
    }
    EXPECT_THAT(comparison_text(all_locked, {"emergency_travel_time_s"}),
                testing::AllOf(HasSubstr("; only 1 pair is without a lock"),
                               HasSubstr("1 lock in 1 of 20 runs, of 78 s; 0 vehicles stood in it")));
    const std::string json = comparison_json(locked_summary(), {"emergency_travel_time_s"}, {});
    EXPECT_THAT(json, HasSubstr("\"locked_runs\": 3"));
    EXPECT_THAT(json, HasSubstr("\"difference_without_locks\": -19.0"));
}

TEST(Shortfalls, AreWhatTheIntervalDoesNotExclude) {
    EXPECT_THAT(shortfalls_of(0.5, "emergency_travel_time_s", 1.5), IsEmpty());
    EXPECT_EQ(shortfalls_of(0.6, "emergency_travel_time_s", 1.5).size(), 1U);
    EXPECT_THAT(shortfalls_of(-20.0, "emergency_travel_time_s", 0.0), IsEmpty()) << "better is never short";
    EXPECT_THAT(shortfalls_of(0.6, "emergency_travel_time_s", 1.5)[0].why,
                HasSubstr("reaches to +1.60 s, 1.5"));
}

TEST(Shortfalls, KnowWhereMoreIsBetter) {
    EXPECT_THAT(shortfalls_of(5.0, "arrived", 0.0), IsEmpty());
    EXPECT_EQ(shortfalls_of(-0.5, "arrived", 1.0).size(), 1U);
    EXPECT_THAT(shortfalls_of(-0.5, "arrived", 1.0)[0].why, HasSubstr("reaches to -1.50"));
}

TEST(Shortfalls, IncludeWhatHasNoInterval) {
    analysis::Summary summary = summary_with(-5.0);
    for (analysis::MetricSummary& metric : summary.scenarios[0].conditions[1].metrics)
        metric.comparison->difference.reset();
    const auto found = shortfalls(summary, {{"collisions", 100.0}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].why, HasSubstr("too few seeds: 18 complete pairs, 5 are needed"));
}

TEST(Shortfalls, IncludeTooFewPairsHoweverGoodTheyAre) {
    analysis::Summary summary = summary_with(-5.0);
    for (analysis::MetricSummary& metric : summary.scenarios[0].conditions[1].metrics) {
        metric.comparison->complete_pairs = 4;
        metric.comparison->difference->n = 4;
    }
    const auto found = shortfalls(summary, {{"collisions", 100.0}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].why, HasSubstr("too few seeds: 4 complete pairs"));
}

TEST(Shortfalls, IncludeRunsThatAreNotThere) {
    analysis::Summary summary = summary_with(-5.0);
    summary.unpaired = {{"city", "gone", "is only in the first folder"}};
    EXPECT_THAT(shortfalls(summary, {}), IsEmpty()) << "no gate was asked for";
    const auto found = shortfalls(summary, {{"collisions", 100.0}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].condition, "gone");
    EXPECT_EQ(found[0].metric, "runs");
    EXPECT_THAT(comparison_text(summary, {"collisions"}),
                HasSubstr("Not paired: city/gone: is only in the first folder\n"));
    const auto json = nlohmann::json::parse(comparison_json(summary, {"collisions"}, found));
    EXPECT_EQ(json["unpaired"][0]["condition"], "gone");
}

TEST(ComparisonText, NamesSettingsInWhichConditionsOfOneNameDifferBeforeTheFigures) {
    analysis::Summary summary = summary_with(-5.0);
    summary.differing = {{"treated", "preempt_signals.lead_s", std::nullopt, "12"}};
    EXPECT_THAT(
        comparison_text(summary, {"collisions"}),
        testing::StartsWith("Conditions of the same name differ:\ntreated: preempt_signals.lead_s is as "
                            "shipped in the first folder and 12 in the\n    second.\n"));
    const auto json = nlohmann::json::parse(comparison_json(summary, {"collisions"}, {}));
    EXPECT_EQ(json["differing_settings"][0]["setting"], "preempt_signals.lead_s");
    EXPECT_TRUE(json["differing_settings"][0]["first"].is_null());
    EXPECT_THAT(comparison_text(summary_with(-5.0), {"collisions"}), Not(HasSubstr("same name")));
}

TEST(ComparisonText, NamesTheBuildsThatMadeTheFoldersIfTheyDiffer) {
    analysis::Summary summary = summary_with(-5.0);
    EXPECT_THAT(comparison_text(summary, {"collisions"}), Not(HasSubstr("builds")));
    EXPECT_FALSE(nlohmann::json::parse(comparison_json(summary, {"collisions"}, {})).contains("builds"));
    summary.builds = {"0123456789abcdef", "an older one"};
    EXPECT_THAT(
        comparison_text(summary, {"collisions"}),
        testing::StartsWith("Made by different builds of Clearway: 0123456789abcdef in the first folder "
                            "and\n    an older one in the second.\n\n"));
    const auto json = nlohmann::json::parse(comparison_json(summary, {"collisions"}, {}));
    EXPECT_EQ(json["builds"]["first"], "0123456789abcdef");
}

TEST(Shortfalls, IncludeLostEmergencyVehiclesHoweverGoodTheMeanOfTheRest) {
    analysis::Summary summary = summary_with(-20.0);
    analysis::Objections& objections = summary.scenarios[0].conditions[1].objections;
    objections.emergency = {.arrived = 18, .running_at_end = 2};
    objections.baseline_emergency = {.arrived = 20};
    EXPECT_THAT(shortfalls(summary, {}), IsEmpty()) << "no gate was asked for";
    const auto found = shortfalls(summary, {{"emergency_travel_time_s", 0.0}});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].metric, "emergency vehicles");
    EXPECT_EQ(found[0].why, "lost 2 of 20 emergency vehicles (2 still on the road at the end; baseline 0)");
    EXPECT_THAT(comparison_text(summary, {"collisions"}),
                testing::StartsWith("city: treated?[2J: lost 2 of 20"));
}

TEST(ComparisonText, SaysTooFewSeedsBelowFivePairs) {
    analysis::Summary summary = summary_with(-3.25);
    for (analysis::MetricSummary& metric : summary.scenarios[0].conditions[1].metrics)
        metric.comparison->complete_pairs = 4;
    const std::string text = comparison_text(summary, {"collisions"});
    EXPECT_THAT(text, HasSubstr("too few seeds"));
    EXPECT_THAT(text, Not(HasSubstr("[-4.25, -2.25]")));
    EXPECT_THAT(text, Not(HasSubstr("<0.001")));
}

TEST(ComparisonText, ShowsPairsIntervalAndPValuesWithinATerminal) {
    const std::string text = comparison_text(summary_with(-3.25), {"emergency_travel_time_s", "collisions"});
    EXPECT_THAT(text, HasSubstr("18 of 20   -3.25  [-4.25, -2.25]"));
    EXPECT_THAT(text, HasSubstr("<0.001    0.250\n"));
    EXPECT_THAT(text, HasSubstr("city: EV travel time, mean of those that arrived, s\n"));
    EXPECT_THAT(text, Not(HasSubstr("\x1b")));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 100U) << line;
}

TEST(ComparisonText, LeavesOutConditionsWithoutAPair) {
    analysis::Summary summary = summary_with(-3.25);
    summary.unpaired = {{"city", "treated", "3 of 3 runs failed or are missing"}};
    EXPECT_THAT(comparison_text(summary, {"collisions"}), HasSubstr("Wilcoxon"));
    for (analysis::MetricSummary& metric : summary.scenarios[0].conditions[1].metrics) {
        metric.comparison->complete_pairs = 0;
        metric.comparison->difference.reset();
    }
    const std::string text = comparison_text(summary, {"collisions"});
    EXPECT_THAT(text, Not(HasSubstr("Wilcoxon")));
    EXPECT_THAT(text, HasSubstr("Not paired: city/treated: 3 of 3 runs failed or are missing\n"));
}

TEST(ComparisonText, HasOneTableOfEvTravelTimeWhereAllArrived) {
    analysis::Summary summary = summary_with(-3.25);
    const std::vector<std::string> both = {analysis::primary_metric, "emergency_travel_time_s"};
    EXPECT_THAT(comparison_text(summary, both),
                HasSubstr("\ncity: EV travel time, mean of those that arrived, s: the same as of all\n\n"));
    auto& metrics = summary.scenarios[0].conditions[1].metrics;
    std::ranges::find(metrics, both[1], [](const auto& metric) {
        return metric.metric.name;
    })->comparison->difference->mean += 1.0;
    EXPECT_THAT(comparison_text(summary, both),
                HasSubstr("\ncity: EV travel time, mean of those that arrived, s\nCondition "));
}

TEST(ComparisonText, HasTheFiguresOfALongTitleBesideIt) {
    const std::string text =
        comparison_text(summary_with(-3.25), {"collisions"},
                        {{{"city", "treated\x1b[2J"}, "Ours: green corridor with lane clearing"}});
    EXPECT_THAT(text, HasSubstr("\nOurs: green         18 of 20   -3.25  [-4.25, -2.25]"));
    EXPECT_THAT(text, HasSubstr("\n  corridor with\n  lane clearing\n"));
}

TEST(ComparisonJson, HoldsComparisonsAndShortfalls) {
    const analysis::Summary summary = summary_with(-3.25);
    const auto found = shortfalls(summary, {{"arrived", 0.0}});
    const auto json = nlohmann::json::parse(comparison_json(summary, {"emergency_travel_time_s"}, found));
    const auto& metric = json["comparisons"][0]["metrics"]["emergency_travel_time_s"];
    EXPECT_EQ(metric["difference"], -3.25);
    EXPECT_EQ(metric["interval_95"][1], -2.25);
    EXPECT_TRUE(metric["relative_1"].is_null());
    EXPECT_EQ(json["short_of_tolerance"][0]["metric"], "arrived");
}

analysis::Summary summary_with_response() {
    analysis::Summary summary = summary_with(-5.0);
    analysis::ResponseTime& response = summary.scenarios[0].conditions[1].response;
    response.threshold_s = 85.0;
    response.percentile_90_s = analysis::Estimate{20, 92.0, 0.0, analysis::Interval{88.0, 99.0}};
    response.percentile_90_difference_s =
        analysis::Estimate{18, -21.5, 0.0, analysis::Interval{-30.0, -14.0}};
    response.in_time = analysis::Estimate{20, 0.75, 0.0, std::nullopt};
    response.in_time_difference = analysis::Estimate{18, 0.25, 0.0, analysis::Interval{0.125, 0.375}};
    return summary;
}

TEST(ComparisonText, HasResponseTimesAndTheShareInTime) {
    EXPECT_THAT(comparison_text(summary_with_response(), {"collisions"}), Not(HasSubstr("response time")));
    const std::string text = comparison_text(summary_with_response(), {"emergency_travel_time_s"});
    EXPECT_THAT(text, HasSubstr("city: EV response time, 90th percentile, s, and trips within 85 s, %\n"));
    EXPECT_THAT(text, HasSubstr("92.0  -21.5 [-30.0, -14.0]"));
    EXPECT_THAT(text, HasSubstr("75.0  +25.0 [12.5, 37.5]"));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 100U) << line;
    EXPECT_THAT(comparison_text(summary_with(-5.0), {"collisions"}), Not(HasSubstr("response")))
        << "no emergency vehicle arrived";
}

TEST(ComparisonJson, HasResponseTimes) {
    const auto json = nlohmann::json::parse(comparison_json(summary_with_response(), {}, {}));
    const auto& response = json["comparisons"][0]["response"];
    EXPECT_EQ(response["threshold_s"], 85.0);
    EXPECT_EQ(response["percentile_90_difference_s"]["value"], -21.5);
    EXPECT_EQ(response["in_time_1"]["bca_95"], nullptr);
    EXPECT_EQ(response["in_time_difference_1"]["bca_95"][1], 0.375);
}

}  // namespace
}  // namespace clearway::report
