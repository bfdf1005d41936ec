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

const std::filesystem::path eval_v1 = CLEARWAY_SOURCE_DIR "/studies/links/eval_v1.toml";

class LinkBenchmarkFile : public testing::Test {
  protected:
    LinkBenchmarkFile() {
        setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
        setenv("SUMO_HOME", "/usr/share/sumo", 0);
    }
    /// The message with which eval_v1 is refused after a change.
    std::string refusal(const std::string& replaced, const std::string& replacement) {
        std::string text = core::read_file(eval_v1);
        const std::size_t at = text.find(replaced);
        if (at == std::string::npos) return "nothing to replace";
        text.replace(at, replaced.size(), replacement);
        try {
            read_link_benchmark(folder_.write("mine.toml", text));
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "accepted";
    }

  private:
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
    for (const scenario::ScenarioConfig& config : benchmark.scenarios)
        EXPECT_EQ(config.version, "v1");
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
}

TEST(SeedRanges, are_judged_before_anything_runs) {
    EXPECT_TRUE(problems_of({0, 10}, {10, 5}, "seeds").empty());
    EXPECT_TRUE(problems_of({20, 10}, {10, 10}, "seeds").empty());
    EXPECT_EQ(problems_of({0, 10}, {5, 1}, "seeds").size(), 1U);
    EXPECT_EQ(problems_of({0, 0}, {0, 0}, "seeds").size(), 2U);
}

}  // namespace
}  // namespace clearway::links
