#include "report/result_rows.hpp"

#include <sstream>

#include <gmock/gmock.h>

#include "report/sample.hpp"
#include "support/message_of.hpp"

namespace clearway::report {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using tests::between;

const std::string travel = analysis::primary_metric;
const std::string header =
    "study,tree,date,seed,pairs,command,scenario,condition,measure,unit,mean,low,high,lost_evs,origin,"
    "behaviour\n";
const RowSource source{"abc1234", "2026-11-24", "clearway study studies/signals.toml", "0123456789ab"};

analysis::ConditionSummary condition(const std::string& name, double level) {
    analysis::ConditionSummary condition;
    condition.condition.name = name;
    condition.emergency.arrived = 209;
    condition.emergency.teleported = 1;
    for (const analysis::MetricInfo& info : analysis::all_metrics())
        condition.metrics.push_back({.metric = info,
                                     .values = {},
                                     .estimate = between(level, level - 2.0, level + 2.0),
                                     .comparison = {}});
    return condition;
}

/// A baseline and a condition that is 25 s or 15 % faster.
analysis::Summary summary() {
    analysis::ConditionSummary treated = condition("corridor", 140.0);
    treated.baseline = "baseline";
    for (analysis::MetricSummary& metric : treated.metrics) {
        metric.comparison.emplace();
        metric.comparison->difference = between(-25.16, -29.0, -21.52);
        metric.comparison->relative = between(-0.15, -0.2, -0.1);
        metric.comparison->complete_pairs = metric.comparison->difference->n;
    }
    analysis::Summary summary;
    summary.manifest.study = "signals";
    summary.manifest.study_seed = 7461;
    summary.scenarios = {{"city", "City", {condition("baseline", 165.0), treated}}};
    return summary;
}

std::vector<std::string> lines(const std::vector<ResultRow>& rows) {
    std::istringstream text(with_rows("", "new.csv", rows));
    std::vector<std::string> all;
    for (std::string line; std::getline(text, line);)
        all.push_back(line);
    return all;
}

TEST(ResultRows, HoldLevelsDifferencesAndPercents) {
    const auto found = lines(study_rows(summary(), {travel}, source));
    const std::string start = "signals,abc1234,2026-11-24,7461,20,clearway study studies/signals.toml,city,";
    const std::string end = ",1 of 210,product,0123456789ab";
    EXPECT_THAT(found,
                testing::ElementsAre(header.substr(0, header.size() - 1),
                                     start + "baseline," + travel + ",s,165.0,163.0,167.0" + end,
                                     start + "corridor," + travel + ",s,140.0,138.0,142.0" + end,
                                     start + "corridor," + travel + ":difference,s,-25.2,-29.0,-21.5" + end,
                                     start + "corridor," + travel + ":percent,%,-15.0,-20.0,-10.0" + end,
                                     start + "corridor," + travel + ":replications,runs,10,," + end));
}

TEST(ResultRows, HoldWhatAFewRunsCannotDecide) {
    analysis::Summary locked = summary();
    for (analysis::MetricSummary& metric : locked.scenarios[0].conditions[1].metrics) {
        metric.comparison->median = -24.04;
        metric.comparison->median_interval = analysis::Interval{-26.0, -20.0};
        metric.comparison->unlocked = between(-24.5, -27.0, -22.0, 18);
        metric.comparison->difference->deviation = 7.0;
    }
    const auto found = lines(study_rows(locked, {travel, "others_time_loss_s"}, source));
    const std::string start = "signals,abc1234,2026-11-24,7461,";
    const std::string middle = ",clearway study studies/signals.toml,city,corridor," + travel;
    const std::string end = ",1 of 210,product,0123456789ab";
    EXPECT_THAT(found, testing::IsSupersetOf({start + "18" + middle + ":unlocked,s,-24.5,-27.0,-22.0" + end,
                                              start + "20" + middle + ":median,s,-24.0,-26.0,-20.0" + end,
                                              start + "20" + middle + ":replications,runs,191,," + end}));
    EXPECT_THAT(found, Not(testing::Contains(HasSubstr("others_time_loss_s:median"))));
}

TEST(ResultRows, HaveNoIntervalOfFewPairs) {
    analysis::Summary few = summary();
    const std::size_t too_few = analysis::fewest_for_interval - 1;
    for (analysis::MetricSummary& metric : few.scenarios[0].conditions[1].metrics)
        metric.comparison->difference = between(-25.16, -29.0, -21.52, too_few);
    EXPECT_THAT(lines(study_rows(few, {travel}, source))[3],
                AllOf(HasSubstr("7461,4,"), HasSubstr(":difference,s,-25.2,,,1 of 210")));
}

TEST(ResultRows, LeaveOutMeansThatHideLostVehicles) {
    analysis::Summary losing = summary();
    losing.scenarios[0].conditions[1].objections.emergency.teleported = 1;
    const auto rows = study_rows(losing, {travel, "emergency_time_loss_s", "others_time_loss_s"}, source);
    std::size_t travel_rows = 0;
    for (const ResultRow& row : rows) {
        if (row.condition != "corridor") continue;
        EXPECT_THAT(row.measure, Not(StartsWith("emergency_time_loss_s")));
        travel_rows += row.measure.starts_with(travel) ? 1 : 0;
    }
    EXPECT_EQ(travel_rows, 4U) << "it counts those lost";
}

TEST(ResultRows, ShowRatiosWithMoreDigits) {
    analysis::Summary small = summary();
    for (analysis::ConditionSummary& each : small.scenarios[0].conditions)
        for (analysis::MetricSummary& metric : each.metrics)
            metric.estimate = between(0.0123, 0.01, 0.02);
    const auto rows = study_rows(small, {"collisions"}, source);
    EXPECT_EQ(rows[0].mean, "0.012");
    EXPECT_EQ(rows[0].unit, "");
}

TEST(ResultRows, ShowThatAnIntervalExcludesZero) {
    analysis::Summary slight = summary();
    for (analysis::MetricSummary& metric : slight.scenarios[0].conditions[1].metrics) {
        metric.comparison->difference = between(-0.18, -0.32, -0.03);
        metric.comparison->relative = between(0.004, 0.0, 0.008);
    }
    const auto rows = study_rows(slight, {travel}, source);
    EXPECT_EQ(rows[2].mean + " " + rows[2].low + " " + rows[2].high, "-0.18 -0.32 -0.03");
    EXPECT_EQ(rows[3].mean + " " + rows[3].low + " " + rows[3].high, "0.4 0.0 0.8") << "it holds 0";
}

TEST(ResultRows, ReplaceThoseOfTheirStudyAndMeasureAndKeepOthers) {
    const std::string other_study = "policies,abc,2026-11-23,1,20,\"a, b\",city,corridor," + travel +
                                    ",s,1.0,,,0 of 7,product,000000000000\n";
    const std::string old_condition =
        "signals,abc,2026-11-23,1,20,c,city,gone," + travel + ",s,1.0,,,0 of 7,product,000000000000\n";
    const std::string other_measure =
        "signals,abc,2026-11-23,1,20,c,city,corridor,collisions,,1.0,,,0 of 7,product,000000000000\n";
    const std::string transcribed =
        "signals,abc,2026-11-23,1,20,c,city,corridor," + travel + ",s,1.0,,,0 of 7,transcribed,\n";
    const std::string kept_transcribed =
        "signals,abc,2026-11-23,1,20,c,town,corridor," + travel + ",s,1.0,,,0 of 7,transcribed,\n";
    const auto rows = study_rows(summary(), {travel}, source);
    const std::string once = with_rows(
        header + other_study + old_condition + other_measure + transcribed + kept_transcribed, "f.csv", rows);
    EXPECT_THAT(once, StartsWith(header + other_study + "signals,abc1234"));
    EXPECT_THAT(once, EndsWith(other_measure + kept_transcribed));
    EXPECT_THAT(once, Not(HasSubstr("gone")));
    EXPECT_THAT(once, Not(HasSubstr(transcribed)));
    EXPECT_EQ(with_rows(once, "f.csv", rows), once);
}

TEST(ResultRows, RefuseAFileOfAnotherKind) {
    const auto refusal = [](const std::string& content) {
        return support::message_of([&] { with_rows(content, "results/x.csv", {}); });
    };
    EXPECT_THAT(refusal("a,b\n1,2\n"), AllOf(HasSubstr("results/x.csv"), HasSubstr("another header")));
    EXPECT_THAT(refusal(header + "a,b\n"), HasSubstr("row 2 has 2 fields and not 16"));
    EXPECT_THAT(refusal(header + "\"a"), HasSubstr("results/x.csv"));
}

TEST(ResultRows, OfLinksArePooledAndNamePredictorAndFailure) {
    LinkFacts facts;
    facts.title = "eval_v1";
    facts.study_seed = 3;
    facts.runs = 40;
    facts.scenarios = {"city", "merge"};
    links::LinkResult result;
    result.failure = "B10";
    result.exits = links::Exits::unknown;
    result.predictor = "graphsage";
    result.end_to_end.f1 = {0.925, analysis::Interval{0.91, 0.94}};
    facts.results.push_back(result);
    result.scenario = "city";
    facts.results.push_back(result);
    const auto rows = link_rows(facts, source);
    ASSERT_EQ(rows.size(), 1U) << "one measure has a value, and one scenario's results are left out";
    EXPECT_EQ(rows[0].scenario, "eval_v1, B10, exits unknown");
    EXPECT_EQ(rows[0].condition, "graphsage");
    EXPECT_EQ(rows[0].measure, "end_to_end_f1");
    EXPECT_EQ(rows[0].mean + rows[0].low + rows[0].high, "0.9250.9100.940");
    EXPECT_EQ(rows[0].pairs, "40");
    facts.scenarios = {"city"};
    facts.results = {result};
    EXPECT_EQ(link_rows(facts, source).size(), 1U) << "there is nothing to pool";
}

TEST(PortableCommand, HasNoPathsOfAMachine) {
    EXPECT_EQ(portable_command("/tree/clearway study /tree/studies/a.toml --out /tmp/x --jobs 2 --quick\n",
                               "/tree"),
              "clearway study studies/a.toml --quick");
    EXPECT_EQ(portable_command("./clearway run /home/me/town --out=x", "/tree"), "clearway run town");
    EXPECT_THAT(portable_command("", "/tree"), IsEmpty());
}

}  // namespace
}  // namespace clearway::report
