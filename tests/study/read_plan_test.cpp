// What a study sets out to show: the plan in its file, and seeds that nobody has looked at.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "results/manifest.hpp"
#include "study/config.hpp"
#include "study/fresh_seeds.hpp"
#include "study/plan.hpp"
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
    manifest.study = "mine";
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
    EXPECT_THAT(
        with("[plan]\nmetric='collisions'\n[[plan.comparison]]\nname='x'\ncondition='corridor'\n"
             "against='baseline'\n"),
        HasSubstr("'collisions' is not a metric in seconds (allowed: columns of runs.csv in seconds)"));
    EXPECT_THAT(
        with("[plan]\nmetric='emergncy_travel_time_s'\n"),
        HasSubstr("(allowed: columns of runs.csv in seconds). Did you mean 'emergency_travel_time_s'?"));
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

TEST_F(PlannedStudy, NamesConditionsByFactorsInAnyOrder) {
    const std::string factors =
        "[factors]\ncondition.failure = ['B10', 'perfect']\ncondition.policy = ['corridor', 'vacate_lane']\n";
    const auto compared = [&](const std::string& condition) {
        return std::string(study_text) + factors + "[plan]\n[[plan.comparison]]\nname='x'\ncondition='" +
               condition + "'\nagainst='corridor+failure=perfect+policy=corridor'\n";
    };
    const std::string in_order = "corridor+failure=B10+policy=vacate_lane";
    for (const std::string& name : {in_order, std::string("corridor+policy=vacate_lane+failure=B10")})
        EXPECT_EQ(read(compared(name)).plan->comparisons[0].condition, in_order);
    const std::string refused = problems(compared("corridor+policy=vacate_lan+failure=B10"));
    EXPECT_THAT(refused, HasSubstr("'corridor+policy=vacate_lan+failure=B10' is not in the study"));
    const std::string both =
        std::string(study_text) + plan_text + "[[plan.comparison]]\nname='y'\ncondition='a'\nagainst='b'\n";
    EXPECT_THAT(problems(both), AllOf(HasSubstr("'a' is not in the study (allowed: baseline"),
                                      HasSubstr("'b' is not in the study (allowed: as above)")));
}

TEST_F(PlannedStudy, NeedsTheTimeAloneOnTheRoadForItsMargin) {
    std::string without_solo = std::string(study_text) + plan_text;
    without_solo.replace(without_solo.find(", \"solo\""), 8, "");
    EXPECT_EQ(problems(without_solo), "none") << "margin_s alone counts then";
    without_solo.replace(without_solo.find("margin_s = 2"), 12, "margin_s = 2\nmargin_share = 0.1");
    EXPECT_THAT(problems(without_solo),
                AllOf(HasSubstr("plan.margin_share"), HasSubstr("Add solo to the conditions")));
    without_solo.replace(without_solo.find("margin_share = 0.1"), 18, "margin_share = 0");
    EXPECT_EQ(problems(without_solo), "none");
}

TEST_F(PlannedStudy, IsRefusedWhenItsPlanCanShowNothing) {
    const std::string no_margin = R"(
[plan]
margin_s = 0
margin_share = 0
[[plan.comparison]]
name = "no harm"
condition = "corridor"
against = "baseline"
)";
    EXPECT_EQ(problems(study_text + no_margin), "none") << "a difference needs no margin";
    EXPECT_THAT(problems(study_text + no_margin + "claim = \"equivalence\"\n"),
                AllOf(HasSubstr("plan.margin_s"), HasSubstr("equivalence cannot be shown"),
                      HasSubstr("one of them above 0"), HasSubstr("Give the least difference")));
    const std::string once = "replications = 1" + std::string(study_text) + plan_text;
    EXPECT_THAT(problems(once), AllOf(HasSubstr("replications: 1 cannot show what [plan] claims"),
                                      HasSubstr("allowed: 2 or more"), HasSubstr("or remove [plan]")));
    EXPECT_EQ(problems("replications = 2" + std::string(study_text) + plan_text +
                       "[quick]\nseed = 78\nreplications = 1\n"),
              "none")
        << "a trial has no plan";
}

TEST_F(PlannedStudy, AsksEachQuestionOnce) {
    const auto repeated = [&](const std::string& more) {
        return problems(std::string(study_text) + plan_text + "[[plan.comparison]]\nname = \"again\"\n" +
                        more);
    };
    const auto is_refusal =
        AllOf(HasSubstr("plan.comparison[2].condition"), HasSubstr("are compared by 'it helps' already"),
              HasSubstr("Remove one of the two"));
    EXPECT_THAT(repeated("condition = \"corridor\"\nagainst = \"baseline\"\n"), is_refusal);
    EXPECT_THAT(repeated("condition = \"baseline\"\nagainst = \"corridor\"\n"), is_refusal);
    EXPECT_THAT(repeated("condition = \"corridor\"\nagainst = \"baseline\"\nscenario = \"merge\"\n"),
                is_refusal)
        << "`it helps` is of every scenario";
    EXPECT_EQ(repeated("condition = \"corridor\"\nagainst = \"baseline\"\nscenario = \"intersection\"\n"
                       "claim = \"equivalence\"\n"),
              "none")
        << "another scenario than `no harm`, another claim than `it helps`";
}

TEST_F(PlannedStudy, SuggestsNamesWithTheirFactors) {
    const std::string text = R"(
name = "planned"
scenarios = ["merge"]
conditions = ["baseline", "solo"]
[[condition]]
name = "a"
policy = ["corridor"]
[[condition]]
name = "b"
failure = "B5"
[factors]
preempt_signals.lease_s = [2, 3]
[plan]
[[plan.comparison]]
name = "x"
condition = "a"
against = "baseline"
)";
    EXPECT_THAT(problems(text), AllOf(HasSubstr("'a' is not in the study"),
                                      HasSubstr("write 'a+lease_s=2' or 'a+lease_s=3'")));
}

TEST_F(PlannedStudy, NamesConditionsByTheirTitles) {
    const std::string text = R"(
seed = 77
scenarios = ["merge"]
conditions = ["baseline"]
replications = 2
[[condition]]
name = "a"
policy = ["corridor"]
[factors]
condition.failure = ["B5", "B10"]
[titles]
baseline = "Nothing"
a = "Ours"
B5 = "one in twenty"
"a+failure=B10" = "Ours, worn"
[plan]
[[plan.comparison]]
name = "x"
against = "Nothing"
condition = )";
    EXPECT_EQ(read(text + "\"Ours, worn\"").plan->comparisons[0].condition, "a+failure=B10");
    EXPECT_EQ(read(text + "\"Ours, one in twenty\"").plan->comparisons[0].condition, "a+failure=B5")
        << "as reports call it";
    const StudyConfig config = read(text + "\"Ours+failure=one in twenty\"");
    EXPECT_EQ(config.plan->comparisons[0].condition, "a+failure=B5");
    EXPECT_EQ(config.plan->comparisons[0].against, "baseline");
    EXPECT_THAT(problems(text + "\"Ours\""), HasSubstr("write 'a+failure=B5' or 'a+failure=B10'"));
    EXPECT_THAT(problems(text + "\"one in twenty, no repair\""), HasSubstr("write 'a+failure=B5'"))
        << "as tables say it";
    EXPECT_THAT(problems(text + "\"one in twenty\""),
                AllOf(HasSubstr("'one in twenty' is not in the study"), HasSubstr("write 'a+failure=B5'")));
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

TEST_F(PlannedStudy, IsRefusedWhenAnotherPlanHasItsSeed) {
    const fs::path file = folder_.write("study.toml", std::string(study_text) + plan_text);
    const StudyConfig config = read_study(file);
    const auto check = [&] { check_fresh_seed(config, file, folder_.path() / "runs" / "planned"); };
    EXPECT_EQ(refusal(check), "none");
    folder_.write("tuned.toml", "seed = 77\nconditions = [\"baseline\"]\n[quick]\nseed = 77\n");
    EXPECT_EQ(refusal(check), "none") << "no plan has fixed the seed, and nothing ran";
    folder_.write("other.toml", "seed = 77\nconditions = [\"baseline\"]\n[plan]\nalpha = 0.05\n");
    EXPECT_THAT(refusal(check), AllOf(HasSubstr("study.toml: seed"), HasSubstr("77 was used before, by"),
                                      HasSubstr("other.toml: it is the seed of its [plan]"),
                                      HasSubstr("Give the study another seed")));
    StudyConfig exploratory = config;
    exploratory.plan.reset();
    EXPECT_NO_THROW(check_fresh_seed(exploratory, file, folder_.path() / "runs" / "planned"));
}

/// A planned study and the run folders beside its own.
class PlannedRuns : public PlannedStudy {
  protected:
    void ran(const std::string& name, const results::Manifest& manifest) {
        prepared(name, manifest);
        const experiment::RunKey first = manifest.runs().front();
        const fs::path run = runs_ / name / "runs" / first.scenario / first.condition / "00000";
        fs::create_directories(run);
        core::write_atomically(run / "run.json", "{}");
    }
    void prepared(const std::string& name, const results::Manifest& manifest) {
        fs::create_directories(runs_ / name);
        core::write_atomically(runs_ / name / "manifest.json", results::to_json(manifest));
    }
    /// Its manifest after `change`, as another version of the program wrote it.
    template <class Change>
    results::Manifest changed(const Change& change) const {
        StudyConfig config = config_;
        change(config);
        return manifest_of(config, {"0.1", "1.0"});
    }
    results::Manifest itself() const {
        return changed([](StudyConfig&) {});
    }
    std::string check() { return check_in(runs_ / "planned"); }
    std::string check_in(const fs::path& folder) {
        return refusal([&] { check_fresh_seed(config_, file_, folder); });
    }
    fs::path file_ = folder_.write("study.toml", std::string(study_text) + plan_text);
    StudyConfig config_ = read_study(file_);
    fs::path runs_ = folder_.path() / "runs";
};

TEST_F(PlannedRuns, GoOnInTheirFolderAndInShards) {
    EXPECT_EQ(check(), "none") << "nothing ran";
    ran("planned", itself());
    ran("shard-2", itself());
    ran("another", changed([](StudyConfig& config) { config.seed = 78; }));
    EXPECT_EQ(check(), "none");
}

TEST_F(PlannedRuns, AreNotExtendedAfterALook) {
    ran("planned", itself());
    config_.replications += 1;
    EXPECT_THAT(check(), AllOf(HasSubstr(fmt::format("planned: {} replications instead of {}",
                                                     config_.replications - 1, config_.replications)),
                               HasSubstr("Go on with those settings")));
}

TEST_F(PlannedRuns, OfAnotherStudyUseUpTheSeed) {
    ran("explored", changed([](StudyConfig& config) { config.name = "explored"; }));
    EXPECT_THAT(check(), AllOf(HasSubstr("study.toml: seed: 77 was used before, by"),
                               HasSubstr("explored: different study name"),
                               HasSubstr("take a seed that was never run")));
}

TEST_F(PlannedRuns, UseUpNoSeedBeforeTheyRanUnlessAPlanHasFixedIt) {
    const results::Manifest exploratory = changed([](StudyConfig& config) { config.plan.reset(); });
    prepared("first", exploratory);
    EXPECT_EQ(check(), "none");
    ran("first", exploratory);
    EXPECT_THAT(check(), testing::ContainsRegex("different plan.*; it ran [a-z]+/[a-z]+/0"));
    prepared("first", changed([](StudyConfig& config) { config.name = "other"; }));
    fs::remove_all(runs_ / "first" / "runs");
    EXPECT_THAT(check(), HasSubstr("; nothing ran, but it is the seed of its plan"));
}

TEST_F(PlannedRuns, WithOtherSettingsUseUpTheSeed) {
    const std::vector<std::pair<std::string, results::Manifest>> others = {
        {"plan", changed([](StudyConfig& config) { config.plan.reset(); })},
        {"conditions",
         changed([](StudyConfig& config) { config.conditions[1].settings["preempt_signals.lead_s"] = "9"; })},
        {"conditions", changed([](StudyConfig& config) { config.conditions.pop_back(); })},
        {"scenarios", changed([](StudyConfig& config) { config.scenarios[0].demand.human += 1; })},
        {"precision", changed([](StudyConfig& config) { config.precision.emplace(); })},
        {"replications", changed([](StudyConfig& config) { config.replications += 1; })}};
    for (const auto& [part, manifest] : others) {
        ran("first", manifest);
        EXPECT_THAT(check(),
                    AllOf(testing::ContainsRegex(part == "replications"
                                                     ? "first: [0-9]+ replications instead of"
                                                     : "first: different " + part + "( \\(|; it ran)"),
                          HasSubstr("Go on with those settings")));
        fs::rename(runs_ / "first", runs_ / "planned");
        if (part != "replications") {
            EXPECT_THAT(check(), HasSubstr("planned: different " + part)) << "in its own folder";
            EXPECT_THAT(check_in(runs_ / "planned" / ""), HasSubstr("planned: different " + part))
                << "with a slash";
            EXPECT_THAT(check_in(runs_ / "other" / ".." / "planned" / "."),
                        HasSubstr("planned: different " + part));
        } else {
            EXPECT_EQ(check(), "none") << "its own folder refuses that itself";
        }
        fs::remove_all(runs_ / "planned");
    }
}

TEST_F(PlannedRuns, ThatCannotBeReadAreNamed) {
    const auto unread = [&] { return check_fresh_seed(config_, file_, runs_ / "planned"); };
    ran("planned", itself());
    fs::create_directories(runs_ / "notes");
    EXPECT_THAT(unread(), testing::IsEmpty());
    ran("damaged", itself());
    core::write_atomically(runs_ / "damaged" / "manifest.json", "{");
    ASSERT_EQ(unread().size(), 1U);
    EXPECT_THAT(unread().front().where, HasSubstr("damaged/manifest.json"));
    fs::create_symlink("loop", runs_ / "loop");
    ASSERT_EQ(unread().size(), 2U);
    EXPECT_THAT(unread().back().what, HasSubstr("cannot be read"));
    EXPECT_THROW(check_fresh_seed(config_, file_, runs_ / "loop" / "planned"), core::InputError);
    config_.plan.reset();
    EXPECT_THAT(unread(), testing::IsEmpty()) << "nothing to confirm";
}

}  // namespace
}  // namespace clearway::study
