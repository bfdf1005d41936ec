#include "links/link_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "links/detail/link_draws.hpp"
#include "links/link_comparisons.hpp"

namespace clearway::links {
namespace {

/// One run with one case. Scores of links are `skill` logits above those of others.
LinkRun run_of(const std::string& scenario, std::uint32_t replication, const std::string& predictor,
               double skill, std::uint32_t pairs = 400) {
    std::mt19937 engine(replication * 7919U + static_cast<std::uint32_t>(scenario.size()));
    std::normal_distribution<double> noise(0.0, 1.0);
    LinkScores scores;
    for (std::uint32_t i = 0; i < pairs; ++i) {
        const bool linked = i % 4 == 0;
        const double logit = noise(engine) + (linked ? skill : -skill);
        scores.add(static_cast<float>(1.0 / (1.0 + std::exp(-logit))), linked, {.age_class = i % 3});
    }
    LinkRun run{.scenario = scenario,
                .configuration_hash = "",
                .study_seed = 1,
                .replication = replication,
                .predictor = predictor,
                .cases = {}};
    run.cases.push_back({"B10", Exits::known, {10, 100, 50, 5, 2, 8}, {30, 6, 4, 90, 20}, scores.summary()});
    return run;
}

LinkRuns runs_of(const std::string& predictor, double skill) {
    LinkRuns runs;
    for (const char* const scenario : {"merge", "city"}) {
        for (std::uint32_t replication = 0; replication < 5; ++replication) {
            runs.test.push_back(run_of(scenario, replication, predictor, skill));
            runs.test_timing.push_back({{{"B10", Exits::known, 10, 100, 0.002}}});
        }
        runs.validation.push_back(run_of(scenario, 100, predictor, skill));
    }
    return runs;
}

const LinkResult& find(const LinkJudgement& judgement, const std::string& predictor,
                       const std::string& scenario) {
    for (const LinkResult& result : judgement.results()) {
        if (result.predictor == predictor && result.scenario == scenario) return result;
    }
    throw std::invalid_argument("no such result");
}

TEST(LinkJudgement, pools_runs_and_lists_every_scenario) {
    LinkJudgement judgement({5, 5});
    const LinkRuns runs = runs_of("kalman", 1.0);
    judgement.add(runs);
    ASSERT_EQ(judgement.results().size(), 3U);
    LinkSummary all;
    LinkSummary city;
    LinkSummary validation;
    for (const LinkRun& run : runs.test) {
        all.add(run.cases[0].scores.of(LinkSubset::all));
        if (run.scenario == "city") city.add(run.cases[0].scores.of(LinkSubset::all));
    }
    for (const LinkRun& run : runs.validation)
        validation.add(run.cases[0].scores.of(LinkSubset::all));
    const double threshold = best_f1_threshold(validation);
    const metrics::LinkQuality expected = link_quality(all, threshold);
    const LinkResult& pooled = find(judgement, "kalman", "");
    EXPECT_DOUBLE_EQ(pooled.threshold, threshold);
    EXPECT_DOUBLE_EQ(pooled.of(LinkSubset::all).ap.value.value(), expected.ap.value());
    EXPECT_DOUBLE_EQ(pooled.of(LinkSubset::all).f1.value.value(), expected.f1.value());
    EXPECT_NEAR(pooled.of(LinkSubset::all).ece.value.value(), expected.ece.value(), 1e-9);
    EXPECT_NEAR(pooled.of(LinkSubset::all).log_loss.value.value(), expected.log_loss.value(), 1e-9);
    EXPECT_EQ(pooled.of(LinkSubset::hard).pairs, 0U);
    EXPECT_FALSE(pooled.of(LinkSubset::hard).ap.value.has_value());
    EXPECT_DOUBLE_EQ(find(judgement, "kalman", "city").of(LinkSubset::all).ap.value.value(),
                     link_quality(city).ap.value());
    EXPECT_EQ(pooled.end_to_end.truth.true_links, 500U);
    EXPECT_EQ(pooled.end_to_end.predicted_away(), 130U);
    EXPECT_DOUBLE_EQ(pooled.end_to_end.recall.value.value(), 0.6);
    EXPECT_DOUBLE_EQ(pooled.end_to_end.precision.value.value(), 30.0 / 36.0);
    EXPECT_DOUBLE_EQ(pooled.end_to_end.policy_recall.value.value(), 0.5);
    EXPECT_DOUBLE_EQ(pooled.end_to_end.ghosts_per_report().value(), 2.0);
    EXPECT_NEAR(pooled.report_us, 200.0, 1e-9);
    EXPECT_DOUBLE_EQ(pooled.report_vehicles, 10.0);
}

/// One run: candidates at .9 (linked), .6 (not) and .3 (linked); one failed link outside the candidates, and
/// one with an end that was never seen.
LinkRun small_run(std::uint32_t replication) {
    LinkScores scores;
    scores.add(0.9F, true, {});
    scores.add(0.6F, false, {});
    scores.add(0.3F, true, {});
    PlaceHistogram places;
    for (const double error_m : {2.05, 2.05, 8.05, 8.05})
        places.add(error_m);
    LinkRun run{.scenario = "merge",
                .configuration_hash = "",
                .study_seed = 1,
                .replication = replication,
                .predictor = "kalman",
                .cases = {}};
    run.cases.push_back({"B10",
                         Exits::known,
                         {.reports = 1,
                          .true_links = 9,
                          .never_seen = 1,
                          .outside = 1,
                          .dark_vehicles = 5,
                          .unseen_vehicles = 1},
                         {.dark_believed = 4, .next_cases = 8, .next_right = 6},
                         scores.summary(),
                         places.errors()});
    return run;
}

LinkResult small_result(const std::vector<LinkRun>& test) {
    LinkRuns runs;
    runs.test = test;
    for (std::size_t i = 0; i < test.size(); ++i)
        runs.test_timing.push_back({{{"B10", Exits::known, 1, 5, 0.001}}});
    runs.validation.push_back(small_run(100));
    LinkJudgement judgement({test.size()});
    judgement.add(runs);
    return judgement.results().at(0);
}

std::vector<LinkRun> small_runs(std::uint32_t count) {
    std::vector<LinkRun> runs;
    for (std::uint32_t replication = 0; replication < count; ++replication)
        runs.push_back(small_run(replication));
    return runs;
}

TEST(LinkJudgement, gives_no_interval_of_few_runs) {
    EXPECT_FALSE(small_result(small_runs(4)).failed.candidate_recall.interval.has_value());
}

TEST(LinkJudgement, counts_links_outside_the_candidates_as_missed) {
    const LinkResult result = small_result(small_runs(5));
    const LinkMeasures& all = result.of(LinkSubset::all);
    EXPECT_NEAR(all.ap.value.value(), 0.5 * 1.0 + 0.5 * 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(all.brier.value.value(), (0.01 + 0.36 + 0.49) / 3.0, 1e-6);
    EXPECT_EQ(result.failed.links, 20U) << "four in each run";
    EXPECT_EQ(result.failed.seen, 15U);
    EXPECT_DOUBLE_EQ(result.failed.candidate_recall.value.value(), 0.5);
    EXPECT_DOUBLE_EQ(result.failed.candidate_recall_seen.value.value(), 2.0 / 3.0);
    EXPECT_NEAR(result.failed.ap.value.value(), 0.25 * 1.0 + 0.25 * 2.0 / 3.0, 1e-12);
    // All three candidates are above the threshold: 2 TP / (2 TP + FP + FN) = 4 / (4 + 1 + 2).
    EXPECT_DOUBLE_EQ(result.failed.f1.value.value(), 4.0 / 7.0);
    for (const analysis::Measured* const measured :
         {&result.failed.candidate_recall, &result.failed.candidate_recall_seen, &result.failed.ap,
          &result.failed.f1, &all.brier})
        EXPECT_TRUE(measured->interval.has_value());
}

TEST(LinkJudgement, without_a_true_candidate_finds_none_of_the_failed_links) {
    LinkRun run = small_run(0);
    LinkScores scores;
    scores.add(0.9F, false, {});
    run.cases[0].scores = scores.summary();
    const LinkResult result = small_result({run});
    EXPECT_FALSE(result.of(LinkSubset::all).ap.value.has_value());
    EXPECT_DOUBLE_EQ(result.failed.ap.value.value(), 0.0);
    EXPECT_DOUBLE_EQ(result.failed.candidate_recall.value.value(), 0.0);
    run.cases[0].truth = {};
    const LinkResult nothing_failed = small_result({run});
    EXPECT_FALSE(nothing_failed.failed.ap.value.has_value());
    EXPECT_FALSE(nothing_failed.failed.candidate_recall.value.has_value());
}

/// Half of the vehicles are off by less than 2.1 m; of the other half nine tenths by less than 8.09 m.
TEST(LinkJudgement, says_how_far_dark_vehicles_are_off_and_who_is_next) {
    const LinkResult result = small_result(small_runs(5));
    EXPECT_EQ(result.dark.vehicles, 25U);
    EXPECT_EQ(result.dark.never_seen, 5U);
    EXPECT_DOUBLE_EQ(result.dark.believed.value.value(), 0.8);
    EXPECT_NEAR(result.dark.place_median_m.value.value(), 2.1, 1e-9);
    EXPECT_NEAR(result.dark.place_p95_m.value.value(), 8.09, 1e-9);
    EXPECT_EQ(result.dark.next_cases, 40U);
    EXPECT_DOUBLE_EQ(result.dark.next_ahead.value.value(), 0.75);
    EXPECT_TRUE(result.dark.place_median_m.interval.has_value());
    EXPECT_TRUE(result.dark.next_ahead.interval.has_value());
}

TEST(LinkJudgement, gives_intervals_of_place_errors_around_them) {
    std::vector<LinkRun> runs;
    std::mt19937 engine(5);
    std::exponential_distribution<double> error_m(0.2);
    for (std::uint32_t replication = 0; replication < 10; ++replication) {
        runs.push_back(small_run(replication));
        PlaceHistogram places;
        for (int i = 0; i < 300; ++i)
            places.add(error_m(engine));
        runs.back().cases[0].places = places.errors();
    }
    const LinkDark dark = small_result(runs).dark;
    EXPECT_NEAR(dark.place_median_m.value.value(), 5.0 * std::log(2.0), 0.5);
    EXPECT_NEAR(dark.place_p95_m.value.value(), 5.0 * std::log(20.0), 1.5);
    for (const analysis::Measured* const measured : {&dark.place_median_m, &dark.place_p95_m}) {
        EXPECT_TRUE(measured->interval->contains(measured->value.value()));
        EXPECT_GT(measured->interval->half_width(), 0.0);
        EXPECT_LT(measured->interval->half_width(), 2.0);
    }
}

TEST(LinkJudgement, gives_intervals_around_the_values) {
    LinkJudgement judgement({5, 5});
    judgement.add(runs_of("kalman", 1.0));
    const LinkMeasures& all = find(judgement, "kalman", "").of(LinkSubset::all);
    for (const analysis::Measured* const measured : {&all.ap, &all.auc, &all.f1, &all.log_loss, &all.ece}) {
        ASSERT_TRUE(measured->interval.has_value());
        EXPECT_TRUE(measured->interval->contains(measured->value.value()));
        EXPECT_GT(measured->interval->half_width(), 0.0);
        EXPECT_LT(measured->interval->half_width(), 0.1);
    }
}

TEST(LinkJudgement, does_not_depend_on_the_order_of_runs) {
    LinkRuns runs = runs_of("kalman", 1.0);
    LinkJudgement forwards({5, 5});
    forwards.add(runs);
    std::reverse(runs.test.begin(), runs.test.begin() + 5);
    std::reverse(runs.test.begin() + 5, runs.test.end());
    LinkJudgement backwards({5, 5});
    backwards.add(runs);
    const LinkMeasures& one = find(forwards, "kalman", "").of(LinkSubset::all);
    const LinkMeasures& other = find(backwards, "kalman", "").of(LinkSubset::all);
    EXPECT_EQ(one.ap.value, other.ap.value);
    EXPECT_EQ(one.log_loss.value, other.log_loss.value);
    EXPECT_NEAR(one.ap.interval->low, other.ap.interval->low, 0.3 * one.ap.interval->half_width());
}

TEST(LinkJudgement, compares_errors_with_an_opponent) {
    LinkJudgement judgement({5, 5});
    judgement.add(runs_of("graphsage", 2.0));
    judgement.add(runs_of("route_rule", 1.0));
    const std::vector<LinkGain> gains = judgement.gains("route_rule");
    ASSERT_EQ(gains.size(), 1U);
    EXPECT_EQ(gains[0].predictor, "graphsage");
    EXPECT_EQ(gains[0].against, "route_rule");
    const double own = find(judgement, "graphsage", "").of(LinkSubset::all).ap.value.value();
    const double theirs = find(judgement, "route_rule", "").of(LinkSubset::all).ap.value.value();
    EXPECT_DOUBLE_EQ(gains[0].ap_error_reduction.value.value(), 1.0 - (1.0 - own) / (1.0 - theirs));
    EXPECT_DOUBLE_EQ(gains[0].ap_difference.value.value(), own - theirs);
    EXPECT_GT(gains[0].ap_error_reduction.interval->low, 0.0);
    EXPECT_TRUE(gains[0].f1_error_reduction.interval->contains(gains[0].f1_error_reduction.value.value()));
    EXPECT_TRUE(judgement.gains("last_seen").empty());
}

TEST(LinkJudgement, of_one_run_a_scenario_gives_no_interval) {
    LinkRuns runs;
    runs.test.push_back(run_of("merge", 0, "none", 1.0));
    runs.test_timing.push_back({{{"B10", Exits::known, 10, 100, 0.002}}});
    runs.validation.push_back(run_of("merge", 1, "none", 1.0));
    LinkJudgement judgement({1});
    judgement.add(runs);
    ASSERT_EQ(judgement.results().size(), 1U);
    EXPECT_EQ(judgement.results()[0].scenario, "merge");
    EXPECT_TRUE(judgement.results()[0].of(LinkSubset::all).ap.value.has_value());
    EXPECT_FALSE(judgement.results()[0].of(LinkSubset::all).ap.interval.has_value());
}

/// Two pairs, one failure, AP and F1: four tests.
TEST(LinkComparisons, adjust_p_values_for_all_tests_and_leave_out_pairs_that_were_not_run) {
    LinkComparisons comparisons({5, 5},
                                {{"graphsage", "kalman"}, {"graphsage", "none"}, {"kalman", "last_seen"}}, 1);
    comparisons.add(runs_of("graphsage", 1.4));
    comparisons.add(runs_of("kalman", 1.0));
    comparisons.add(runs_of("none", 1.4));
    comparisons.add(runs_of("route_rule", 3.0));
    const std::vector<LinkComparison> results = comparisons.results();
    ASSERT_EQ(results.size(), 2U) << "last_seen was not run";
    EXPECT_EQ(results[0].pair, (ComparedPair{"graphsage", "kalman"}));
    EXPECT_EQ(results[0].failure, "B10");
    LinkJudgement judgement({5, 5});
    judgement.add(runs_of("graphsage", 1.4));
    judgement.add(runs_of("kalman", 1.0));
    const auto value = [&](const char* predictor) {
        return find(judgement, predictor, "").of(LinkSubset::all).ap.value.value();
    };
    EXPECT_DOUBLE_EQ(results[0].ap.difference.value.value(), value("graphsage") - value("kalman"));
    EXPECT_GT(results[0].ap.difference.interval->low, 0.0);
    EXPECT_LT(results[0].ap.p.value(), 0.05);
    // The same runs under another name: no difference, and p = 1 stays 1.
    EXPECT_DOUBLE_EQ(results[1].ap.difference.value.value(), 0.0);
    EXPECT_DOUBLE_EQ(results[1].ap.p.value(), 1.0);
    EXPECT_DOUBLE_EQ(results[1].f1.holm_p.value(), 1.0);
    const std::vector<double> adjusted = analysis::holm(std::vector<double>{
        results[0].ap.p.value(), results[0].f1.p.value(), results[1].ap.p.value(), results[1].f1.p.value()});
    EXPECT_DOUBLE_EQ(results[0].ap.holm_p.value(), adjusted[0]);
    EXPECT_DOUBLE_EQ(results[0].f1.holm_p.value(), adjusted[1]);
    EXPECT_GE(results[0].ap.holm_p.value(), 3.0 * results[0].ap.p.value());
}

TEST(LinkComparisons, without_pairs_compare_nothing) {
    LinkComparisons comparisons({5, 5}, {}, 1);
    comparisons.add(runs_of("kalman", 1.0));
    EXPECT_TRUE(comparisons.results().empty());
}

/// 99 values of which 4 are at most 0: share (4 + 1) / 100, a normal quantile of -1.6449. Ten runs widen it
/// by sqrt(10/9), and with 9 degrees of freedom P(t < -1.6449 / sqrt(10/9)) is 0.0766.
TEST(RunResampling, gives_a_two_sided_p_value_that_agrees_with_its_interval) {
    const analysis::RunResampling resampling({10}, {.resamples = 99});
    std::vector<double> values(99, 1.0);
    std::fill_n(values.begin(), 4, -1.0);
    EXPECT_NEAR(resampling.p(values).value(), 2.0 * 0.0766, 1e-3);
    for (double& value : values)
        value = -value;
    EXPECT_NEAR(resampling.p(values).value(), 2.0 * 0.0766, 1e-3) << "either side";
    EXPECT_DOUBLE_EQ(resampling.p(std::vector<double>(99, 0.0)).value(), 1.0);
    EXPECT_FALSE(resampling.p(std::vector<double>{0.1, std::nan("")}).has_value());
    EXPECT_FALSE(analysis::RunResampling({1}).p(values).has_value()) << "one run";

    const analysis::RunResampling many({10}, {.resamples = 2000});
    std::mt19937 engine(3);
    std::normal_distribution<double> noise(0.0, 1.0);
    std::vector<double> draws(2000);
    for (double& draw : draws)
        draw = noise(engine);
    const analysis::Interval interval = many.interval(draws).value();
    const auto p_at = [&](double shift) {
        std::vector<double> shifted = draws;
        for (double& value : shifted)
            value += shift;
        return many.p(shifted).value();
    };
    EXPECT_LT(p_at(0.2 - interval.low), 0.05) << "the interval lies just above 0";
    EXPECT_GT(p_at(-0.2 - interval.low), 0.05) << "the interval just holds 0";
}

TEST(RunResampling, draws_within_strata_and_repeats_itself) {
    const analysis::RunResampling resampling({3, 2});
    ASSERT_EQ(resampling.runs(), 5U);
    bool repeated = false;
    for (std::size_t number = 0; number < resampling.resamples(); ++number) {
        const auto weights = resampling.weights(number);
        EXPECT_DOUBLE_EQ(weights[0] + weights[1] + weights[2], 3.0);
        EXPECT_DOUBLE_EQ(weights[3] + weights[4], 2.0);
        repeated = repeated || weights[0] == 3.0;
        EXPECT_TRUE(std::ranges::equal(
            weights, analysis::RunResampling({3, 2}, {.resamples = number + 1}).weights(number)));
        if (number > 20) break;
    }
    EXPECT_TRUE(repeated);
}

TEST(RunResampling, intervals_of_ten_runs_hold_the_true_ratio_about_as_often_as_they_say) {
    const analysis::RunResampling resampling({10}, {.resamples = 400});
    std::mt19937 engine(1);
    std::normal_distribution<double> noise(0.0, 1.0);
    constexpr int samples = 400;
    int held = 0;
    for (int sample = 0; sample < samples; ++sample) {
        std::vector<double> above;
        std::vector<double> below;
        for (int run = 0; run < 10; ++run) {
            below.push_back(10.0 + noise(engine));
            above.push_back(0.5 * below.back() + noise(engine));
        }
        const analysis::Measured ratio = detail::draw_ratio(above, below, resampling).measured(resampling);
        held += ratio.interval->contains(0.5) ? 1 : 0;
    }
    EXPECT_GE(held, samples * 91 / 100);
    EXPECT_LE(held, samples * 99 / 100);
}

}  // namespace
}  // namespace clearway::links
