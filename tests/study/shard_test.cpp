#include "study/shard.hpp"

#include <map>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "experiment/conditions.hpp"
#include "study/submission.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

using testing::HasSubstr;

Plan example_plan() {
    StudyConfig config;
    config.replications = 7;
    for (const char* name : {"alpha", "beta"})
        config.scenarios.emplace_back().name = name;
    for (const experiment::BuiltInCondition& known : experiment::built_in_conditions())
        config.conditions.push_back(known.condition);
    return make_plan(config, {"0.1.0", "1.15.0"}, "/out");
}

TEST(Shards, HaveEveryUnitOnceWhateverTheirNumber) {
    for (const std::uint32_t count : {1U, 2U, 3U, 4U, 5U, 28U, 40U}) {
        std::map<std::string, int> seen;
        std::size_t runs = 0;
        for (std::uint32_t index = 1; index <= count; ++index) {
            Plan plan = example_plan();
            keep_shard(plan, {index, count});
            runs += plan.run_count();
            for (const PlannedUnit& unit : plan.units)
                ++seen[unit.name];
        }
        EXPECT_EQ(seen.size(), 28U) << count;
        EXPECT_EQ(runs, example_plan().run_count()) << count;
        EXPECT_TRUE(std::ranges::all_of(seen, [](const auto& entry) { return entry.second == 1; })) << count;
    }
}

TEST(Shards, MixEnginesAndScenarios) {
    for (std::uint32_t index = 1; index <= 4; ++index) {
        Plan plan = example_plan();
        keep_shard(plan, {index, 4});
        std::map<std::pair<std::string, experiment::TrafficModel>, int> kinds;
        for (const PlannedUnit& unit : plan.units)
            ++kinds[{unit.unit.scenario, unit.unit.traffic_model}];
        EXPECT_EQ(kinds.size(), 4U) << "shard " << index << " lacks a kind of unit";
    }
}

TEST(Shards, AreReadAndRefusedAsTyped) {
    EXPECT_EQ(shard_from("3/8", "--shard"), (Shard{3, 8}));
    for (const char* const wrong :
         {"9/8", "0/8", "1/0", "0/0", "3", "3/", "/8", "-1/8", "3/8x", "3/99999999999", ""}) {
        try {
            shard_from(wrong, "--shard");
            ADD_FAILURE() << wrong;
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("--shard"), HasSubstr("3/8"))) << wrong;
        }
    }
}

TEST(Shards, KeepTheirFolderToThemselves) {
    const support::TemporaryFolder folder;
    const auto place = folder.path() / "out";
    const results::Manifest manifest = example_plan().manifest;
    claim(place, {2, 3});
    results::Store::create(place, manifest);
    EXPECT_EQ(shard_of(place), (Shard{2, 3}));
    EXPECT_NO_THROW(claim(place, {2, 3}));
    for (const Shard& other : {Shard{1, 3}, Shard{2, 4}, Shard{}}) {
        try {
            claim(place, other);
            ADD_FAILURE() << to_text(other);
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("holds shard 2/3"));
        }
    }
    const auto whole = folder.path() / "whole";
    claim(whole, {});
    results::Store::create(whole, manifest);
    EXPECT_THROW(claim(whole, {1, 2}), core::InputError);
}

TEST(Submission, QuotesWhatAShellWouldReadOtherwise) {
    Submission submission;
    submission.engine = SubmitEngine::slurm;
    submission.shards = 12;
    submission.program = "/opt/my programs/clearway";
    submission.study = "/data/a'b.toml";
    submission.folder = "/data/my out";
    submission.shard_limit_s = 601.0;
    submission.study_options = {"--memory-limit", "300"};
    std::map<std::string, std::string> texts;
    for (const Script& script : scripts_of(submission))
        texts[script.name] = script.text;
    EXPECT_EQ(texts.size(), 5U);
    EXPECT_THAT(texts["shard.sh"],
                HasSubstr("'/opt/my programs/clearway' study '/data/a'\\''b.toml' --shard"));
    EXPECT_THAT(texts["shard.sh"], HasSubstr("--memory-limit 300"));
    EXPECT_THAT(texts["array.sbatch"],
                testing::AllOf(HasSubstr("#SBATCH --array=1-12"), HasSubstr("#SBATCH --time=11"),
                               HasSubstr("#SBATCH --requeue"), HasSubstr("--signal=B:TERM@60"),
                               HasSubstr("#SBATCH --output=\"/data/my out/logs/slurm-%a.log\"\n"),
                               HasSubstr("\nbash '/data/my out'/shard.sh ")));
    EXPECT_THAT(texts["merge.sbatch"],
                testing::AllOf(HasSubstr("#SBATCH --output=\"/data/my out/logs/merge.log\"\n"),
                               HasSubstr("exec bash '/data/my out'/merge.sh\n")));
    EXPECT_THAT(texts["merge.sh"], testing::AllOf(HasSubstr("count=12 folder='/data/my out'\n"),
                                                  HasSubstr("merge \"$folder\" --out \"$folder/merged\"\n")));
    EXPECT_THAT(texts["submit.sh"], HasSubstr("afterany"));
}

TEST(Submission, RefusesAFolderThatSbatchCannotBeTold) {
    Submission submission;
    for (const char* const folder : {"/data/a\"b", "/data/a\\b", "/data/%a", "/data/a\nb", "/data/\x7f"}) {
        submission.folder = folder;
        submission.engine = SubmitEngine::slurm;
        EXPECT_THROW(scripts_of(submission), core::InputError) << folder;
        submission.engine = SubmitEngine::local;
        EXPECT_NO_THROW(scripts_of(submission)) << folder;
    }
}

}  // namespace
}  // namespace clearway::study
