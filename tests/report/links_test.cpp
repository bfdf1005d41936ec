#include "report/links.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace clearway::report {
namespace {

using analysis::Interval;
using analysis::Measured;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Measured measured(double value) {
    return {value, Interval{value - 0.01, value + 0.01}};
}

links::LinkResult result_of(const std::string& predictor, const std::string& scenario, double ap) {
    links::LinkScores scores;
    for (int i = 0; i < 2000; ++i) {
        const float probability = static_cast<float>(i) / 1999.0F;
        scores.add(probability, i % 2 == 0 && i > 600, {.age_class = static_cast<std::size_t>(i % 3)});
    }
    links::LinkResult result;
    result.scenario = scenario;
    result.failure = "B10";
    result.exits = links::Exits::known;
    result.predictor = predictor;
    result.threshold = 0.4;
    result.subsets[0] = {2000,          700,           measured(ap),   measured(0.9),
                         measured(0.8), measured(0.3), measured(0.02), measured(0.07)};
    result.failed = {1000, 950, measured(0.7), measured(0.74), measured(0.66), measured(0.58)};
    result.dark = {400, 20, measured(0.95), measured(3.25), measured(41.5), 300, measured(0.62)};
    result.end_to_end.truth = {10, 100, 50, 5, 2, 8};
    result.end_to_end.belief = {30, 6, 4, 90, 20};
    result.end_to_end.policy_recall = measured(0.5);
    result.scores = scores.summary();
    return result;
}

LinkFacts sample(const std::string& odd = "city") {
    LinkFacts facts;
    facts.title = "merge, " + odd;
    facts.command = "clearway links evaluate merge '" + odd + "'";
    facts.split = "test";
    facts.study_seed = 8101;
    facts.seeds = "replications 0 to 9";
    facts.scenarios = {"merge", odd};
    facts.failures = {"B10"};
    facts.exits = {links::Exits::known};
    facts.predictors = {"graphsage", "route_rule"};
    facts.against = "route_rule";
    for (const char* const predictor : {"graphsage", "route_rule"}) {
        facts.results.push_back(result_of(predictor, "", 0.95));
        facts.results.push_back(result_of(predictor, odd, 0.9));
    }
    facts.gains.push_back({"B10", links::Exits::known, "graphsage", "route_rule", measured(0.05),
                           measured(0.65), measured(0.33)});
    return facts;
}

std::string page_of(const LinkFacts& facts) {
    std::ostringstream page;
    write_links_page(facts, page);
    return page.str();
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

TEST(LinksConsole, prints_measures_and_errors_against_the_opponent) {
    const std::string text = links_console(sample());
    EXPECT_THAT(text, AllOf(HasSubstr("Links, exits known"), HasSubstr("1 - AP below that of route_rule"),
                            HasSubstr("65 [64, 66]")));
    EXPECT_THAT(text,
                HasSubstr("B10       graphsage                .9500   .8000   .7000   .6600   .5800\n"));
    EXPECT_THAT(
        text,
        HasSubstr("B10       graphsage                .0200   .0700   .9500     3.2    41.5   .6200\n"));
}

TEST(LinksConsole, keeps_within_80_columns_and_gives_a_long_failure_a_line_of_its_own) {
    LinkFacts facts = sample();
    facts.against.clear();
    facts.failures = {"B10,dark_share=0.5,exits=unknown"};
    for (links::LinkResult& result : facts.results) {
        result.failure = facts.failures[0];
        if (result.predictor == "graphsage") result.predictor = "graphsage_as_published";
    }
    facts.predictors[0] = "graphsage_as_published";
    const std::string text = links_console(facts);
    EXPECT_THAT(text,
                HasSubstr("\nB10,dark_share=0.5,exits=unknown\n          graphsage_as_published   .9500"));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 80U) << line;
}

TEST(LinksJson, holds_every_measure_with_its_interval) {
    const auto document = nlohmann::json::parse(links_json(sample()));
    const auto& result = document.at("results").at(0);
    EXPECT_TRUE(result.at("scenario").is_null());
    EXPECT_DOUBLE_EQ(result.at("ap"), 0.95);
    EXPECT_DOUBLE_EQ(result.at("ap_low_95"), 0.94);
    EXPECT_DOUBLE_EQ(result.at("ap_high_95"), 0.96);
    EXPECT_DOUBLE_EQ(result.at("f1_threshold"), 0.4);
    EXPECT_EQ(result.at("lost_never_seen"), 5);
    EXPECT_EQ(result.at("lost_outside_candidates"), 2);
    EXPECT_EQ(result.at("lost_predicted_away"), 13);
    EXPECT_TRUE(result.at("hard_ap").is_null());
    EXPECT_DOUBLE_EQ(result.at("brier"), 0.07);
    EXPECT_EQ(result.at("failed_links"), 1000);
    EXPECT_EQ(result.at("failed_links_seen"), 950);
    EXPECT_DOUBLE_EQ(result.at("candidate_recall"), 0.7);
    EXPECT_DOUBLE_EQ(result.at("candidate_recall_seen_low_95"), 0.73);
    EXPECT_DOUBLE_EQ(result.at("ap_failed"), 0.66);
    EXPECT_DOUBLE_EQ(result.at("f1_failed_high_95"), 0.59);
    EXPECT_EQ(result.at("dark_vehicles"), 400);
    EXPECT_EQ(result.at("dark_never_seen"), 20);
    EXPECT_DOUBLE_EQ(result.at("dark_believed"), 0.95);
    EXPECT_DOUBLE_EQ(result.at("place_error_median_m"), 3.25);
    EXPECT_DOUBLE_EQ(result.at("place_error_p95_m_low_95"), 41.49);
    EXPECT_EQ(result.at("next_ahead_cases"), 300);
    EXPECT_DOUBLE_EQ(result.at("next_ahead_accuracy"), 0.62);
    EXPECT_DOUBLE_EQ(document.at("gains").at(0).at("ap_error_reduction"), 0.65);
}

LinkFacts with_comparisons() {
    LinkFacts facts = sample();
    links::LinkComparison one{.failure = "B10",
                              .exits = links::Exits::known,
                              .pair = {"graphsage", "route_rule"},
                              .ap = {},
                              .f1 = {}};
    one.ap = {{0.0142, Interval{0.0031, 0.0252}}, 0.0004, 0.0008};
    one.f1 = {{-0.002, Interval{-0.01, 0.006}}, 0.4, 0.4};
    facts.comparisons = {one};
    facts.confirmatory = true;
    facts.exploratory_gains = true;
    return facts;
}

TEST(LinksConsole, says_which_comparisons_are_confirmatory) {
    LinkFacts facts = with_comparisons();
    EXPECT_THAT(
        links_console(facts),
        AllOf(HasSubstr("exits known (confirmatory)"), HasSubstr("for all 2 tests"),
              HasSubstr("graphsage minus route_rule\nB10       +.0142 [+.0031, +.0252]  p<.001"),
              HasSubstr("-.0020 [-.0100, +.0060]  p .400\n"), HasSubstr("exits known (exploratory)\n")));
    facts.confirmatory = false;
    EXPECT_THAT(links_console(facts), HasSubstr("(exploratory: a part of the benchmark)"));
    EXPECT_THAT(links_console(sample()), Not(HasSubstr("exploratory")));
}

TEST(LinksJson, holds_the_comparisons_named_in_advance) {
    const auto document = nlohmann::json::parse(links_json(with_comparisons()));
    EXPECT_TRUE(document.at("confirmatory").get<bool>());
    const auto& one = document.at("comparisons").at(0);
    EXPECT_EQ(one.at("against"), "route_rule");
    EXPECT_DOUBLE_EQ(one.at("ap_difference"), 0.0142);
    EXPECT_DOUBLE_EQ(one.at("ap_difference_low_95"), 0.0031);
    EXPECT_DOUBLE_EQ(one.at("ap_p"), 0.0004);
    EXPECT_DOUBLE_EQ(one.at("ap_p_holm"), 0.0008);
    EXPECT_DOUBLE_EQ(one.at("f1_p_holm"), 0.4);
    EXPECT_FALSE(nlohmann::json::parse(links_json(sample())).contains("comparisons"));
}

TEST(LinksPage, says_which_comparisons_are_confirmatory) {
    LinkFacts facts = with_comparisons();
    EXPECT_THAT(page_of(facts),
                AllOf(HasSubstr("They are confirmatory"), HasSubstr("0.0142 [0.0031, 0.0252]")));
    facts.confirmatory = false;
    EXPECT_THAT(page_of(facts), AllOf(HasSubstr("Only part"), Not(HasSubstr("They are confirmatory"))));
}

TEST(LinksCsv, is_a_row_a_result_under_one_head_with_odd_names_quoted) {
    const std::string text = links_csv(sample("my \"city\", east"));
    EXPECT_EQ(count(text, "\n"), 5U);
    EXPECT_TRUE(text.starts_with("scenario,failure,exits,predictor,pairs,true_links,ap,ap_low_95,"));
    EXPECT_THAT(text, HasSubstr("\n\"my \"\"city\"\", east\",B10,known,graphsage,2000,700,0.9,"));
}

TEST(LinksPage, draws_three_curves_with_their_data) {
    const std::string page = page_of(sample());
    EXPECT_EQ(count(page, "<figure"), 3U);
    EXPECT_THAT(page, AllOf(HasSubstr("Precision over recall"), HasSubstr("Reliability"),
                            HasSubstr("Average precision by age"), HasSubstr("0.9500 [0.9400, 0.9600]")));
    EXPECT_GE(count(page, "<polyline"), 6U);
    EXPECT_THAT(page, AllOf(HasSubstr("All failed links"), HasSubstr("70.0 [69.0, 71.0]"),
                            HasSubstr("Brier score"), HasSubstr("0.0700 [0.0600, 0.0800]"),
                            HasSubstr("Dark vehicles, and the next vehicle ahead"),
                            HasSubstr("41.5 [41.5, 41.5]"), HasSubstr("62.0 [61.0, 63.0]")));
}

TEST(LinksPage, is_self_contained_and_escapes_what_others_named) {
    const std::string page = page_of(sample("<script>alert(1)</script>"));
    EXPECT_THAT(page, AllOf(Not(HasSubstr("<script")), HasSubstr("&lt;script&gt;"), Not(HasSubstr("http://")),
                            Not(HasSubstr("src=")), HasSubstr("default-src 'none'")));
}

TEST(LinksPage, of_nothing_scored_has_no_curves) {
    LinkFacts facts = sample();
    for (links::LinkResult& result : facts.results) {
        result.scores = {};
        result.subsets = {};
    }
    EXPECT_EQ(count(page_of(facts), "<figure"), 0U);
}

}  // namespace
}  // namespace clearway::report
