// What a study sets out to show: the plan in its file, and seeds that nobody has looked at.
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "results/manifest.hpp"
#include "study/config.hpp"
#include "study/fresh_seeds.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* study_text = R"(
name = "planned"
seed = 77
scenarios = ["merge", "intersection"]
conditions = ["baseline", "corridor", "solo"]
)";
constexpr const char* plan_text = R"(
[plan]
alpha = 0.01
margin_s = 2
[[plan.comparison]]
name = "it helps"
condition = "corridor"
against = "baseline"
[[plan.comparison]]
name = "no harm"
scenario = "merge"
condition = "baseline"
against = "corridor"
claim = "equivalence"
)";

class PlannedStudy : public testing::Test {
  protected:
    PlannedStudy() { setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1); }
    StudyConfig read(const std::string& text, Extent extent = Extent::whole) {
        return read_study(folder_.write("study.toml", text), extent);
    }
    template <class Call>
    static std::string refusal(const Call& call) {
        try {
            call();
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }
    std::string problems(const std::string& text) {
        return refusal([&] { read(text); });
    }
    support::TemporaryFolder folder_;
};

TEST_F(PlannedStudy, ReadsItsComparisons) {
    const StudyConfig config = read(std::string(study_text) + plan_text);
    ASSERT_TRUE(config.plan);
    EXPECT_EQ(config.plan->metric, "emergency_restricted_travel_time_s");
    EXPECT_DOUBLE_EQ(config.plan->alpha, 0.01);
    EXPECT_DOUBLE_EQ(config.plan->margin_s, 2.0);
    EXPECT_DOUBLE_EQ(config.plan->margin_share, 0.05);
    ASSERT_EQ(config.plan->comparisons.size(), 2U);
    EXPECT_EQ(config.plan->comparisons[0], (results::PlannedComparison{"it helps", "", "corridor", "baseline",
                                                                       results::Claim::difference}));
    EXPECT_EQ(config.plan->comparisons[1].scenario, "merge");
    EXPECT_EQ(config.plan->comparisons[1].claim, results::Claim::equivalence);
    EXPECT_FALSE(read(study_text).plan);
}

TEST_F(PlannedStudy, KeepsThePlanInTheManifest) {
    results::Manifest manifest;
    manifest.plan = read(std::string(study_text) + plan_text).plan;
    const results::Manifest same = results::manifest_from_json(results::to_json(manifest), "manifest.json");
    EXPECT_EQ(same.plan, manifest.plan);
    results::Manifest other = manifest;
    other.plan->comparisons[0].against = "solo";
    EXPECT_EQ(results::differences(manifest, other), "plan") << "another plan is another study";
}

TEST_F(PlannedStudy, RefusesAPlanThatDoesNotFit) {
    const auto with = [&](const std::string& more) { return problems(std::string(study_text) + more); };
    EXPECT_THAT(with("[plan]\n"), AllOf(HasSubstr("plan.comparison"), HasSubstr("is missing")));
    EXPECT_THAT(with("[plan]\nalpha = 0.5\n[[plan.comparison]]\nname='x'\ncondition='corridor'\n"
                     "against='baseline'\n"),
                AllOf(HasSubstr("plan.alpha"), HasSubstr("0.5")));
    EXPECT_THAT(with("[plan]\nmetric='collisions'\n[[plan.comparison]]\nname='x'\ncondition='corridor'\n"
                     "against='baseline'\n"),
                HasSubstr("'collisions' is not a metric in seconds"));
    EXPECT_THAT(with("[plan]\n[[plan.comparison]]\nname='x'\ncondition='coridor'\nagainst='baseline'\n"),
                AllOf(HasSubstr("plan.comparison[0].condition"), HasSubstr("'coridor' is not in the study"),
                      HasSubstr("Did you mean 'corridor'?")));
    EXPECT_THAT(with("[plan]\n[[plan.comparison]]\nname='x'\ncondition='corridor'\nagainst='corridor'\n"),
                HasSubstr("is the condition itself"));
    EXPECT_THAT(with("[plan]\n[[plan.comparison]]\nname='x'\nscenario='city'\ncondition='corridor'\n"
                     "against='baseline'\n"),
                AllOf(HasSubstr("'city' is not in the study"), HasSubstr("merge, intersection")));
    EXPECT_THAT(
        with(std::string(plan_text) + "[precision]\nmetric='emergency_travel_time_s'\nhalf_width=1\n"),
        HasSubstr("is given together with [plan]"));
}

TEST_F(PlannedStudy, NeedsTheTimeAloneOnTheRoadForItsMargin) {
    std::string without_solo = std::string(study_text) + plan_text;
    without_solo.replace(without_solo.find(", \"solo\""), 8, "");
    EXPECT_THAT(problems(without_solo),
                AllOf(HasSubstr("plan.margin_share"), HasSubstr("Add solo to the conditions")));
    without_solo.replace(without_solo.find("margin_s = 2"), 12, "margin_s = 2\nmargin_share = 0");
    EXPECT_EQ(problems(without_solo), "none");
}

TEST_F(PlannedStudy, TriesOutOnOtherSeedsAndConfirmsNothingThere) {
    const std::string same = std::string(study_text) + plan_text + "[quick]\nreplications = 2\n";
    EXPECT_THAT(problems(same), AllOf(HasSubstr("quick.seed"), HasSubstr("77 is that of the study")));
    const std::string other = std::string(study_text) + plan_text + "[quick]\nseed = 78\nreplications = 2\n";
    EXPECT_EQ(problems(other), "none");
    const StudyConfig quick = read(other, Extent::quick);
    EXPECT_EQ(quick.seed, 78U);
    EXPECT_FALSE(quick.plan);
}

TEST_F(PlannedStudy, IsRefusedWhenAnotherStudyFileHasItsSeed) {
    const fs::path file = folder_.write("study.toml", std::string(study_text) + plan_text);
    const StudyConfig config = read_study(file);
    const auto check = [&] { check_fresh_seed(config, file, folder_.path() / "runs" / "planned"); };
    EXPECT_EQ(refusal(check), "none");
    folder_.write("notes.toml", "seed = 77\n");
    EXPECT_EQ(refusal(check), "none") << "no study: it has no conditions";
    folder_.write("tuned.toml", "seed = 77\nconditions = [\"baseline\"]\n");
    EXPECT_THAT(refusal(check), AllOf(HasSubstr("study.toml: seed"), HasSubstr("77 was used before, by"),
                                      HasSubstr("tuned.toml"), HasSubstr("Give the study another seed")));
    folder_.write("tuned.toml", "seed = 1\nconditions = [\"baseline\"]\n[quick]\nseed = 77\n");
    EXPECT_THAT(refusal(check), HasSubstr("tuned.toml")) << "its trials";
    StudyConfig exploratory = config;
    exploratory.plan.reset();
    EXPECT_NO_THROW(check_fresh_seed(exploratory, file, folder_.path() / "runs" / "planned"));
}

TEST_F(PlannedStudy, IsRefusedWhenAnotherStudyRanOnItsSeed) {
    const fs::path file = folder_.write("study.toml", std::string(study_text) + plan_text);
    const StudyConfig config = read_study(file);
    const fs::path runs = folder_.path() / "runs";
    const auto ran = [&](const std::string& name, const std::string& study, std::uint64_t seed,
                         const std::optional<results::AnalysisPlan>& plan = std::nullopt) {
        results::Manifest manifest;
        manifest.study = study;
        manifest.study_seed = seed;
        manifest.plan = plan;
        fs::create_directories(runs / name);
        core::write_atomically(runs / name / "manifest.json", results::to_json(manifest));
    };
    const auto check = [&] { check_fresh_seed(config, file, runs / "planned"); };
    ran("planned", "planned", 77, config.plan);
    ran("another", "another", 78);
    EXPECT_EQ(refusal(check), "none") << "the study itself, continued";
    fs::rename(runs / "planned", runs / "elsewhere");
    EXPECT_EQ(refusal(check), "none") << "its shards";
    ran("elsewhere", "planned", 77);
    EXPECT_THAT(refusal(check), HasSubstr("elsewhere")) << "the same study before it had a plan";
    fs::remove_all(runs / "elsewhere");
    ran("explored", "explored", 77);
    EXPECT_THAT(refusal(check), AllOf(HasSubstr("77 was used before"), HasSubstr("explored")));
}

}  // namespace
}  // namespace clearway::study
