#include "links/link_benchmark.hpp"

#include <cstdlib>
#include <set>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::links {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::filesystem::path eval_v1 = CLEARWAY_SOURCE_DIR "/studies/links/eval_v1.toml";

class LinkBenchmarkFile : public testing::Test {
  protected:
    LinkBenchmarkFile() {
        setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
        setenv("SUMO_HOME", "/usr/share/sumo", 0);
    }
    /// eval_v1 after a change.
    LinkBenchmark read(const std::string& replaced, const std::string& replacement) {
        std::string text = core::read_file(eval_v1);
        const std::size_t at = text.find(replaced);
        if (at == std::string::npos) throw std::invalid_argument("nothing to replace");
        text.replace(at, replaced.size(), replacement);
        return read_link_benchmark(folder_.write("mine.toml", text));
    }
    /// The message with which it is refused then.
    std::string refusal(const std::string& replaced, const std::string& replacement) {
        try {
            read(replaced, replacement);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    support::TemporaryFolder folder_;
};

/// Every figure of link prediction is measured on this. A change makes all of them void: then call it
/// eval_v2.
TEST_F(LinkBenchmarkFile, eval_v1_is_frozen) {
    EXPECT_EQ(core::content_hash(core::read_file(eval_v1)), "b87136a8f246e309031a8855c876a56e");
    const LinkBenchmark benchmark = read_link_benchmark(eval_v1);
    EXPECT_EQ(benchmark.name, "eval_v1");
    EXPECT_EQ(benchmark.test, (SeedRange{0, 10}));
    EXPECT_EQ(benchmark.validation, (SeedRange{100, 5}));
    EXPECT_EQ(benchmark.failures.size(), 17U);
    ASSERT_EQ(benchmark.scenarios.size(), 3U);
    for (const BenchmarkScenario& entry : benchmark.scenarios) {
        EXPECT_EQ(entry.config.version, "v1");
        EXPECT_EQ(entry.label, entry.config.name);
        EXPECT_EQ(entry.policy, "");
    }
    EXPECT_TRUE(benchmark.predictors.empty());
    EXPECT_TRUE(benchmark.comparisons.empty());
    EXPECT_EQ(benchmark.candidates, prediction::CandidateReach::reported) << "there was no other reach";
    EXPECT_EQ(benchmark.links, experiment::LinkSettings{});
}

TEST_F(LinkBenchmarkFile, states_candidates_and_link_rules) {
    const LinkBenchmark benchmark =
        read("exits = ",
             "candidates = \"twins\"\nlinks = { link_radius_m = 80.0, automated_links = 1 }\nexits = ");
    EXPECT_EQ(benchmark.candidates, prediction::CandidateReach::twins);
    EXPECT_EQ(benchmark.links.link_radius_m, 80.0);
    EXPECT_TRUE(
        benchmark.links.rules().allows(traffic::VehicleClass::automated, traffic::VehicleClass::automated));
    EXPECT_THAT(refusal("exits = ", "candidates = \"twin\"\nexits = "), HasSubstr("reported"));
    EXPECT_THAT(refusal("exits = ", "links = { link_radius_m = 0.0, automated_links = 0 }\nexits = "),
                HasSubstr("link_radius_m"));
}

TEST_F(LinkBenchmarkFile, lists_that_are_empty_or_repeat_or_name_what_is_not_there_are_refused) {
    EXPECT_THAT(refusal("exits = ", "predictors = []\nexits = "), HasSubstr("predictors: is empty"));
    EXPECT_THAT(refusal("\"B10\"", "\"B10\", \"B10\""), HasSubstr("`B10` is listed twice"));
    EXPECT_THAT(refusal("[seeds]", "[quick]\nfailures = [\"S0\"]\n[seeds]"),
                HasSubstr("`S0` is not among the benchmark's failures"));
}

TEST_F(LinkBenchmarkFile, names_code_of_the_user_beside_it) {
    const std::filesystem::path file = folder_.write("mine.py", "class Mine: pass\nclass Other: pass\n");
    const LinkBenchmark benchmark = read("exits = ",
                                         "predictors = [\"mine.py:Mine\", \"route_rule\"]\n"
                                         "comparisons = [[\"mine.py:Mine\", \"route_rule\"]]\nexits = ");
    ASSERT_EQ(benchmark.predictors.size(), 2U);
    EXPECT_THAT(benchmark.predictors[0], StartsWith(file.string() + ":Mine@"));
    EXPECT_EQ(benchmark.predictors[1], "route_rule");
    ASSERT_EQ(benchmark.comparisons.size(), 1U);
    EXPECT_EQ(benchmark.comparisons[0].predictor, "Mine") << "as tables know it";
    EXPECT_EQ(benchmark.comparisons[0].against, "route_rule");

    EXPECT_THAT(refusal("exits = ", "predictors = [\"their.py:Mine\"]\nexits = "),
                AllOf(HasSubstr("mine.toml:"), HasSubstr("their.py")));
    const std::string compared = "comparisons = [[\"mine.py:Other\", \"route_rule\"]]\nexits = ";
    for (const char* const judged : {"", "predictors = [\"mine.py:Mine\", \"route_rule\"]\n"})
        EXPECT_THAT(refusal("exits = ", judged + compared),
                    HasSubstr("`Other` is not among the benchmark's predictors"));
}

/// A change makes figures that were measured on it void: then it is another benchmark.
TEST_F(LinkBenchmarkFile, eval_v2_is_frozen_and_has_a_study_seed_of_its_own) {
    const std::filesystem::path file = CLEARWAY_SOURCE_DIR "/studies/links/eval_v2.toml";
    EXPECT_EQ(core::content_hash(core::read_file(file)), "0fb8f9968ed7f0cac3f68183b29ac1cb");
    const LinkBenchmark benchmark = read_link_benchmark(file);
    EXPECT_EQ(benchmark.candidates, prediction::CandidateReach::twins);
    EXPECT_EQ(benchmark.quick.test, 1U);
    EXPECT_THAT(benchmark.quick.failures, testing::ElementsAre("B10", "B20", "mixed"));
    EXPECT_EQ(benchmark.quick.exits, std::vector{Exits::known});
    EXPECT_EQ(benchmark.name, "eval_v2");
    EXPECT_EQ(benchmark.test, (SeedRange{0, 10}));
    EXPECT_EQ(benchmark.validation, (SeedRange{100, 3}));
    EXPECT_EQ(benchmark.study_seed, 8201U);
    EXPECT_NE(benchmark.study_seed, read_link_benchmark(eval_v1).study_seed);
    std::set<std::string> scenarios;
    for (const BenchmarkScenario& entry : benchmark.scenarios)
        scenarios.insert(entry.config.name);
    EXPECT_THAT(scenarios, testing::ElementsAre("city", "grid_signals", "intersection", "merge",
                                                "random_town", "spider"));
}

/// Its tables compare these; a predictor that came later is judged when it is named.
TEST(BenchmarkPredictors, are_those_of_when_eval_v1_was_frozen) {
    EXPECT_THAT(benchmark_predictors(),
                testing::ElementsAre("none", "last_seen", "dead_reckoning", "dead_reckoning_heading",
                                     "kalman", "route_rule", "common_neighbours", "logistic",
                                     "graphsage_as_published", "graphsage_corrected", "graphsage"));
}

TEST_F(LinkBenchmarkFile, eval_v1_shares_no_seed_with_a_training) {
    const LinkBenchmark benchmark = read_link_benchmark(eval_v1);
    std::set<std::uint64_t> study_seeds;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(CLEARWAY_SOURCE_DIR "/models")) {
        if (entry.path().filename() != "summary.json") continue;
        const auto summary = nlohmann::json::parse(core::read_file(entry.path()));
        if (!summary.contains("seeds")) continue;
        for (const auto& [part, seeds] : summary.at("seeds").items()) {
            for (const auto& seed : seeds)
                study_seeds.insert(seed.at("study_seed").get<std::uint64_t>());
        }
    }
    EXPECT_FALSE(study_seeds.empty()) << "the trainings that are shipped say their seeds";
    EXPECT_FALSE(study_seeds.contains(benchmark.study_seed));
}

TEST_F(LinkBenchmarkFile, refuses_seeds_that_overlap_or_lack) {
    EXPECT_THAT(
        refusal("first = 100", "first = 9"),
        AllOf(HasSubstr("mine.toml"), HasSubstr("test seeds 0 to 9 and validation seeds 9 to 13 overlap"),
              HasSubstr("at 100 or above")));
    EXPECT_THAT(refusal("count = 10", "count = 0"), AllOf(HasSubstr("mine.toml:10"), HasSubstr("count")));
    EXPECT_THAT(refusal("validation =", "validaton ="),
                AllOf(HasSubstr("validaton"), HasSubstr("no seeds to validate on")));
}

TEST_F(LinkBenchmarkFile, refuses_a_scenario_that_is_not_what_it_was) {
    EXPECT_THAT(
        refusal("variant = \"dense\"", "variant = \"standard\""),
        AllOf(HasSubstr("merge has changed since the benchmark was frozen"), HasSubstr("mine.toml:16")));
    EXPECT_THAT(refusal("name = \"merge\"", "name = \"mergee\""), HasSubstr("Did you mean 'merge'?"));
    EXPECT_THAT(refusal("configuration = ", "# "), HasSubstr("Add configuration = \""));
}

/// A variant of the intersection.
const std::string second_entry =
    "[[scenario]]\nname = \"intersection\"\nlabel = \"intersection_treiber\"\npolicy = \"corridor\"\n"
    "idm = \"treiber\"\ndensity = 0.5\nautomated_share = 0.25\n";

TEST_F(LinkBenchmarkFile, states_variants_of_a_scenario_with_a_policy_and_options) {
    // The hash is not known here: the refusal prints it, and only it.
    const std::string told = refusal("[[scenario]]\nname = \"intersection\"\n", second_entry);
    EXPECT_THAT(told, HasSubstr("its configuration has the hash "));
    const std::string before = "has the hash ";
    const std::string hash = told.substr(told.find(before) + before.size(), 32);
    const LinkBenchmark benchmark = read(
        "[[scenario]]\nname = \"intersection\"\nvariant = \"dense\"\n"
        "configuration = \"24067ac92a444b24d23df620e2945794\"",
        second_entry + "variant = \"dense\"\nconfiguration = \"" + hash + "\"");
    ASSERT_EQ(benchmark.scenarios.size(), 3U);
    const BenchmarkScenario& entry = benchmark.scenarios[1];
    EXPECT_EQ(entry.label, "intersection_treiber");
    EXPECT_EQ(entry.policy, "corridor");
    EXPECT_EQ(entry.config.name, "intersection");
    EXPECT_EQ(entry.config.drivers.idm, scenario::IdmPreset::treiber);
    EXPECT_DOUBLE_EQ(entry.config.demand.density, 3.5) << "half of the dense variant's 7";
}

TEST_F(LinkBenchmarkFile, refuses_entries_that_cannot_be_told_apart_or_are_out_of_range) {
    const std::string name = "name = \"intersection\"\n";
    EXPECT_THAT(refusal(name, "name = \"merge\"\n"),
                AllOf(HasSubstr("`merge` is used twice"), HasSubstr("label")));
    EXPECT_THAT(refusal(name, name + "label = \"merge\"\n"), HasSubstr("`merge` is used twice"));
    EXPECT_THAT(refusal(name, name + "label = \"../up\"\n"), HasSubstr("`../up` cannot name a folder"));
    EXPECT_THAT(refusal(name, name + "policy = \"coridor\"\n"),
                AllOf(HasSubstr("`coridor` is not a policy"), HasSubstr("Did you mean 'corridor'?")));
    EXPECT_THAT(refusal(name, name + "idm = \"krauss\"\n"), AllOf(HasSubstr("krauss"), HasSubstr("treiber")));
    EXPECT_THAT(refusal(name, name + "automated_share = 1.5\n"),
                AllOf(HasSubstr("1.5 is out of range"), HasSubstr("0 to 1")));
    EXPECT_THAT(refusal(name, name + "density = -1\n"), HasSubstr("-1 is out of range"));
}

TEST_F(LinkBenchmarkFile, names_predictors_and_comparisons_in_advance) {
    const std::string seeds = "[seeds]\n";
    const LinkBenchmark benchmark =
        read(seeds,
             "predictors = [\"kalman\", \"graphsage\", \"none\"]\n"
             "comparisons = [[\"graphsage\", \"kalman\"], [\"graphsage\", \"none\"]]\n" +
                 seeds);
    EXPECT_THAT(benchmark.predictors, testing::ElementsAre("kalman", "graphsage", "none"));
    EXPECT_THAT(benchmark.comparisons,
                testing::ElementsAre(ComparedPair{"graphsage", "kalman"}, ComparedPair{"graphsage", "none"}));
    const auto refused = [&](const std::string& lines) { return refusal(seeds, lines + seeds); };
    EXPECT_THAT(refused("comparisons = [[\"graphsage\"]]\n"), HasSubstr("a comparison names 1 predictors"));
    EXPECT_THAT(refused("comparisons = [\"graphsage\", \"none\"]\n"),
                HasSubstr("an array of arrays of texts"));
    EXPECT_THAT(refused("comparisons = [[\"graphsage\", \"kalmann\"]]\n"),
                HasSubstr("Did you mean 'kalman'?"));
    EXPECT_THAT(refused("comparisons = [[\"none\", \"none\"]]\n"), HasSubstr("compared with itself"));
    EXPECT_THAT(refused("comparisons = [[\"none\", \"kalman\"], [\"kalman\", \"none\"]]\n"),
                HasSubstr("kalman and none are compared twice"));
    EXPECT_THAT(refused("predictors = [\"none\"]\ncomparisons = [[\"none\", \"kalman\"]]\n"),
                HasSubstr("`kalman` is not among the benchmark's predictors"));
    EXPECT_THAT(refused("predictors = [\"nnone\"]\n"), HasSubstr("Did you mean 'none'?"));
}

TEST(SeedRanges, are_judged_before_anything_runs) {
    EXPECT_TRUE(problems_of({0, 10}, {10, 5}, "seeds").empty());
    EXPECT_TRUE(problems_of({20, 10}, {10, 10}, "seeds").empty());
    EXPECT_EQ(problems_of({0, 10}, {5, 1}, "seeds").size(), 1U);
    EXPECT_EQ(problems_of({0, 0}, {0, 0}, "seeds").size(), 2U);
}

}  // namespace
}  // namespace clearway::links
