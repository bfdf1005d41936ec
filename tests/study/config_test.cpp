#include "study/config.hpp"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "experiment/conditions.hpp"
#include "scenario/overrides.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

using testing::HasSubstr;
using testing::Not;

class StudyFile : public testing::Test {
  protected:
    StudyFile() { setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1); }
    StudyConfig read(const std::string& text) { return read_study(folder_.write("study.toml", text)); }
    std::string problems(const std::string& text) {
        try {
            read(text);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }
    support::TemporaryFolder folder_;
};

TEST_F(StudyFile, TellsAMisspeltKeyAndNotWhatFollowsFromIt) {
    const std::string begin = "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n";
    const std::string titles =
        "condition.failure = [\"B10\"]\n[titles]\nB10 = \"outages\"\nQ50 = \"losses\"\n";
    EXPECT_THAT(problems(begin + "[factor]\n" + titles),
                testing::AllOf(HasSubstr("unknown key"), HasSubstr("Did you mean 'factors'?"),
                               testing::Not(HasSubstr("\n"))));
    EXPECT_THAT(problems(begin + "[factors]\n" + titles),
                HasSubstr("titles.Q50: is no condition, and no text"));
    const std::string named = begin + "[[condition]]\nnmae = \"corridor\"\npolicy = \"hold_green\"\n";
    EXPECT_THAT(problems(named + "[titles]\ncorridor = \"ours\"\n"), testing::Not(HasSubstr("titles.")));
    EXPECT_THAT(problems("replicatons = 3\nseeed = 1\n" + begin + "[titles]\nbaselin = \"old\"\n"),
                testing::AllOf(HasSubstr("Did you mean 'replications'?"),
                               HasSubstr("titles.baselin: is no condition, and no text")))
        << "no condition depends on those keys";
}

TEST_F(StudyFile, TellsAMissingFileOnceForAllThatFactorsMakeOfACondition) {
    const std::string told = problems(
        "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n[[condition]]\nname = \"mine\"\n"
        "policy = [\"absent.py:Mine\"]\n[factors]\ncondition.failure = [\"perfect\", \"B10\"]\n");
    EXPECT_THAT(told, testing::AllOf(HasSubstr("study.toml: condition mine: policy: "),
                                     HasSubstr("absent.py is not a file"), testing::Not(HasSubstr("\n"))));
}

TEST_F(StudyFile, GivesScenariosConditionsAndOverrides) {
    const StudyConfig config = read(R"(
name = "outages"
seed = 7
replications = 30
scenarios = ["merge", "intersection"]
conditions = ["baseline", "solo"]
[overrides]
variant = "dense"
step_length_s = 0.1
[[condition]]
name = "b20"
failure = "B20"
predictor = "dead_reckoning"
policy = ["dissertation"]
safety_checks = "off"
)");
    EXPECT_EQ(config.name, "outages");
    EXPECT_EQ(config.seed, 7U);
    EXPECT_EQ(config.replications, 30U);
    ASSERT_EQ(config.scenarios.size(), 2U);
    EXPECT_DOUBLE_EQ(config.scenarios[0].time.step_length_s, 0.1);
    EXPECT_GT(config.scenarios[0].demand.emergency, 3);
    ASSERT_EQ(config.conditions.size(), 3U);
    EXPECT_EQ(config.conditions[1], experiment::built_in_condition("solo", ""));
    EXPECT_EQ(config.conditions[2].failure, "B20");
    EXPECT_EQ(config.conditions[2].safety_checks, traffic::SafetyChecks::off);
}

TEST_F(StudyFile, GivesAScenarioOverridesAndANameOfItsOwn) {
    const StudyConfig config = read(R"(
scenarios = ["merge"]
conditions = ["baseline"]
condition = [{name = "light", bluelight = "on"}]
scenario = [{name = "crossing", from = "intersection", road_limit_kmh = 70.0, siren_compliance = 0.5, friction = 0.7}]
[overrides]
step_length_s = 0.1
)");
    ASSERT_EQ(config.scenarios.size(), 2U);
    EXPECT_EQ(config.scenarios[0].limits.road_kmh, 0.0);
    EXPECT_EQ(config.scenarios[1].name, "crossing");
    EXPECT_EQ(config.scenarios[1].limits.road_kmh, 70.0);
    EXPECT_EQ(config.scenarios[1].siren.compliance, 0.5);
    EXPECT_EQ(config.scenarios[1].road.friction, 0.7);
    EXPECT_EQ(config.scenarios[1].time.step_length_s, 0.1);
    EXPECT_EQ(config.conditions[1].bluelight, traffic::BlueLight::on);
}

/// A study with a line of overrides and one of factors.
std::string study_with(const std::string& override, const std::string& factor) {
    return "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n[overrides]\n" + override +
           "\n[factors]\n" + factor + "\n";
}

TEST_F(StudyFile, TakesEveryOverrideAsKeyAndAsFactorWithItsRange) {
    for (const scenario::Override& override : scenario::overrides()) {
        const core::SettingInfo& value = override.value;
        const auto line = [&](double number) { return fmt::format("{} = {}", value.name, number); };
        if (override.is_number()) {
            const std::string factor = fmt::format("scenario.{} = [{}]", value.name, value.maximum);
            const double beyond = value.maximum * 2.0 + 1.0;
            const std::string says =
                fmt::format("{} is out of range (allowed: {} to {}", beyond, value.minimum, value.maximum);
            EXPECT_THAT(problems(study_with(line(value.maximum), "")), Not(HasSubstr("out of range")));
            EXPECT_THAT(problems(study_with("", factor)), Not(HasSubstr("out of range")));
            EXPECT_THAT(problems(study_with(line(beyond), "")),
                        HasSubstr(fmt::format("study.toml:4:1: overrides.{}: {}", value.name, says)));
            EXPECT_THAT(problems(study_with("", fmt::format("scenario.{} = [{}]", value.name, beyond))),
                        HasSubstr(fmt::format("overrides.{}, set by a factor: {}", value.name, says)));
        } else {
            EXPECT_THAT(problems(study_with(value.name + " = \"no such word\"", "")),
                        testing::AllOf(HasSubstr(fmt::format("study.toml:4:1: overrides.{}", value.name)),
                                       HasSubstr("no such word")));
        }
        EXPECT_THAT(
            problems(study_with(value.name + " = true", "")),
            HasSubstr(fmt::format("study.toml:4:1: overrides.{}: is a truth value, true", value.name)));
    }
}

TEST_F(StudyFile, SaysWhatIsWrongWithAScenarioOfItsOwn) {
    const std::string rest = "\nconditions = [\"baseline\"]\n";
    EXPECT_THAT(problems("scenario = [{from = \"merge\"}]" + rest), HasSubstr("scenario.name"));
    EXPECT_THAT(problems("scenario = [{name = \"m\", from = \"merge\", varant = \"dense\"}]" + rest),
                HasSubstr("Did you mean 'variant'?"));
}

TEST_F(StudyFile, LeavesOfItselfWhatQuickNames) {
    const std::string text = R"(
name = "outages"
scenarios = ["merge", "intersection"]
conditions = ["baseline"]
condition = [{name = "a", failure = "dark_share=0.1"}, {name = "b", failure = "dark_share=0.9"}]
[quick]
replications = 3
scenarios = ["merge"]
conditions = ["baseline", "b"]
)";
    const auto file = folder_.write("study.toml", text);
    EXPECT_EQ(read_study(file).conditions.size(), 3U);
    EXPECT_EQ(read_study(file).replications, 20U);
    const StudyConfig quick = read_study(file, Extent::quick);
    EXPECT_EQ(quick.name, "outages-quick");
    EXPECT_EQ(quick.replications, 3U);
    ASSERT_EQ(quick.scenarios.size(), 1U);
    EXPECT_EQ(quick.scenarios[0].name, "merge");
    ASSERT_EQ(quick.conditions.size(), 2U);
    EXPECT_EQ(quick.conditions[1].failure, "dark_share=0.9");
}

TEST_F(StudyFile, SaysWhatIsWrongWithQuick) {
    const std::string text = "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n";
    const std::string wrong = problems(
        text + "[quick]\nreplications = 0\nscenarios = [\"merg\"]\nconditions = [\"solo\"]\nseeds = 3\n");
    EXPECT_THAT(wrong, testing::AllOf(HasSubstr("replications"), HasSubstr("Did you mean 'merge'?"),
                                      HasSubstr("'solo' is not in the study"), HasSubstr("unknown key")));
    try {
        read_study(folder_.write("study.toml", text), Extent::quick);
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("[quick]"));
    }
}

TEST_F(StudyFile, reads_which_conditions_are_controls_of_which) {
    const std::string text = R"(
scenarios = ["merge"]
conditions = ["baseline"]
condition = [{name = "b10", failure = "B10", policy = ["corridor"]}, {name = "blind", failure = "B40", policy = ["corridor"]}]
[controls]
blind = "b10"
)";
    EXPECT_EQ(read(text).controls, (core::Settings{{"blind", "b10"}}));
    const StudyConfig varied = read(text + "[factors]\npreempt_signals.lead_s = [4, 8]\n");
    EXPECT_EQ(varied.controls,
              (core::Settings{{"blind+lead_s=4", "b10+lead_s=4"}, {"blind+lead_s=8", "b10+lead_s=8"}}));
    const auto quick =
        folder_.write("quick.toml", text + "[quick]\nconditions = [\"baseline\", \"blind\"]\n");
    EXPECT_TRUE(read_study(quick, Extent::quick).controls.empty()) << "what it is a control of does not run";
    EXPECT_THAT(problems(text + "b1 = \"b10\"\n"), HasSubstr("'b1' is not in the study"));
    EXPECT_THAT(problems(text + "baseline = \"b1\"\n"),
                testing::AllOf(HasSubstr("'b1' is not in the study"), HasSubstr("Did you mean 'b10'?")));
    EXPECT_THAT(problems(text + "baseline = \"blind\"\n"), HasSubstr("'blind' is a control itself"));
    EXPECT_THAT(problems(text + "b10 = \"b10\"\n"), HasSubstr("'b10' is a control itself"));
}

TEST_F(StudyFile, runs_on_other_scenarios_than_its_own) {
    const std::string text = R"(
name = "outages"
scenarios = ["merge", "intersection"]
conditions = ["baseline"]
scenario = [{name = "thick", from = "merge", variant = "dense"}]
[overrides]
step_length_s = 0.1
[quick]
replications = 3
scenarios = ["merge"]
)";
    const auto file = folder_.write("study.toml", text);
    const StudyConfig config =
        read_study(file, Extent::quick, results::usual_most_runs, {"spider", "city_v2"});
    EXPECT_EQ(config.name, "outages-spider-city_v2-quick");
    EXPECT_EQ(config.replications, 3U);
    ASSERT_EQ(config.scenarios.size(), 2U);
    EXPECT_EQ(config.scenarios[0].name, "spider");
    EXPECT_DOUBLE_EQ(config.scenarios[0].time.step_length_s, 0.1);
    const std::string scenario = std::string(CLEARWAY_SOURCE_DIR) + "/scenarios/spider/";
    EXPECT_EQ(read_study(file, Extent::whole, results::usual_most_runs, {scenario}).name, "outages-spider");
    EXPECT_EQ(read_study(file, Extent::whole, results::usual_most_runs, {scenario + "scenario.toml"}).name,
              "outages-spider");
    EXPECT_THROW(read_study(file, Extent::whole, results::usual_most_runs, {"spidr"}), core::InputError);
}

std::size_t runs_of(const StudyConfig& config) {
    return config.scenarios.size() * config.conditions.size() * config.replications;
}

TEST(ShippedStudies, CanBeReadWholeAndQuickWhereTheySaySo) {
    setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
    std::size_t read = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(CLEARWAY_SOURCE_DIR) + "/studies")) {
        if (entry.path().extension() != ".toml") continue;
        EXPECT_FALSE(read_study(entry.path()).conditions.empty()) << entry.path();
        if (core::read_file(entry.path()).find("[quick]\n") == std::string::npos) continue;
        EXPECT_LT(runs_of(read_study(entry.path(), Extent::quick)), runs_of(read_study(entry.path())))
            << entry.path();
        ++read;
    }
    EXPECT_GT(read, 0U) << "studies/sensor_failure.toml has one";
}

TEST_F(StudyFile, IsTheShippedOneWhereThereIsNoFileOfThatPath) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());
    EXPECT_EQ(read_study("studies/parts.toml").name, "parts");
    EXPECT_THROW(read_study("studies"), core::Error) << "a folder";
    EXPECT_THROW(read_study("studies/part.toml"), core::Error);
    std::filesystem::create_directory("studies");
    folder_.write("studies/parts.toml",
                  "name = \"mine\"\nscenarios = [\"merge\"]\nconditions = [\"solo\"]\n");
    EXPECT_EQ(read_study("studies/parts.toml").name, "mine");
    std::filesystem::current_path(before);
}

TEST_F(StudyFile, RefusesSettingsAndModelsThatDoNotExist) {
    const std::string begin =
        "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n[[condition]]\n"
        "name = \"corridor\"\npolicy = [\"corridor\"]\n";
    EXPECT_EQ(problems(begin + "set = { \"clear_lane.horizon_m\" = 300 }\n"), "none");
    EXPECT_THAT(problems(begin + "set = { \"clear_lane.horizn_m\" = 300 }\n"),
                testing::AllOf(HasSubstr("study.toml:6:"), HasSubstr("'horizon_m'")));
    EXPECT_THAT(problems(begin + "set = { \"clear_lane.horizon_m\" = -1 }\n"),
                HasSubstr("-1 is out of range"));
    EXPECT_THAT(problems(begin + "set = { \"clear_lane.horizon_m\" = [1] }\n"), HasSubstr("is not a value"));
    EXPECT_THAT(problems(begin + "model = \"none.weights\"\n"), HasSubstr("none.weights is not a file"));
}

TEST_F(StudyFile, ReportsAllProblemsWithTheirLines) {
    const std::string message = problems(R"(replikations = 30
replications = -3
scenarios = ["merg"]
conditions = ["base line"]
[overrides]
variant = "denser"
density = "much"
[[condition]]
failure = "B20"
polcy = ["dissertation"]
)");
    EXPECT_THAT(message, HasSubstr("study.toml:1:"));
    EXPECT_THAT(message, HasSubstr("Did you mean 'replications'?"));
    EXPECT_THAT(message, HasSubstr("study.toml:2:"));
    EXPECT_THAT(message, HasSubstr("-3 is negative"));
    EXPECT_THAT(message, HasSubstr("merge"));
    EXPECT_THAT(message, HasSubstr("'baseline'"));
    EXPECT_THAT(message, HasSubstr("study.toml:6:1: overrides.variant: \"denser\" is not known"));
    EXPECT_THAT(message, HasSubstr("overrides.density: is text, \"much\" (allowed: a number)"));
    EXPECT_THAT(message, HasSubstr("Did you mean 'policy'?"));
    EXPECT_THAT(message, HasSubstr("condition.name"));
}

TEST_F(StudyFile, RefusesWhatIsNoTomlAndWhatIsEmpty) {
    EXPECT_THAT(problems("scenarios = [\n"), HasSubstr("study.toml:"));
    EXPECT_THAT(problems(""), testing::AllOf(HasSubstr("the study has no scenario"),
                                             HasSubstr("the study has no condition")));
    EXPECT_THAT(problems("replications = 0\nscenarios = [\"merge\"]\nconditions = [\"baseline\"]\n"),
                HasSubstr("0 is out of range"));
    EXPECT_THROW(read_study(folder_.path() / "none.toml"), core::InputError);
}

TEST_F(StudyFile, DissertationStudyHasItsScenariosConditionsAndControls) {
    setenv("SUMO_HOME", "/usr/share/sumo", 0);
    const StudyConfig config =
        read_study(std::filesystem::path(CLEARWAY_SOURCE_DIR) / "studies/dissertation.toml");
    const auto names = [](const auto& list) {
        std::vector<std::string> all;
        for (const auto& one : list)
            all.push_back(one.name);
        return all;
    };
    EXPECT_THAT(names(config.scenarios),
                testing::ElementsAre("merge", "merge_dense", "intersection", "city"));
    EXPECT_GT(config.scenarios[1].demand.density * config.scenarios[1].demand.human,
              2.0 * config.scenarios[0].demand.density * config.scenarios[0].demand.human);
    EXPECT_THAT(
        names(config.conditions),
        testing::ElementsAre("baseline", "graph_simulation", "graph_graphsage", "graph_graphsage_improved",
                             "graph_graphsage_as_published", "b10_no_repair", "b10_dead_reckoning", "solo"));
    EXPECT_EQ(config.name, "dissertation")
        << "the report shows the published tables beside a study of this name";
    EXPECT_EQ(config.replications, 20U);
}

}  // namespace
}  // namespace clearway::study
