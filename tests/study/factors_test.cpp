#include "study/detail/factors.hpp"

#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "experiment/related_conditions.hpp"
#include "experiment/settings.hpp"
#include "study/config.hpp"
#include "study/plan.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Factors : public testing::Test {
  protected:
    Factors() { setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1); }
    StudyConfig read(const std::string& factors) {
        return read_study(folder_.write("study.toml", R"(
replications = 2
scenarios = ["merge"]
conditions = ["baseline", "graph_simulation", "solo"]
)" + factors));
    }
    std::string problems(const std::string& factors) {
        try {
            read(factors);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }
    static std::vector<std::string> names(const auto& entries) {
        std::vector<std::string> list;
        for (const auto& entry : entries)
            list.push_back(entry.name);
        return list;
    }
    support::TemporaryFolder folder_;
};

TEST_F(Factors, KnowNoNegativeZero) {
    const StudyConfig config = read("[factors]\nscenario.demand.density = [-0.0, 1.0]\n");
    EXPECT_THAT(names(config.scenarios), ElementsAre("merge+density=0", "merge+density=1"));
}

TEST_F(Factors, CrossWithConditionsThatTheyConcern) {
    const StudyConfig config = read(R"([factors]
condition.failure = ["B5", "B20"]
failure.dark_share = [0.1, 0.25]
)");
    EXPECT_THAT(names(config.conditions),
                ElementsAre("baseline", "graph_simulation+failure=B5+dark_share=0.1",
                            "graph_simulation+failure=B5+dark_share=0.25",
                            "graph_simulation+failure=B20+dark_share=0.1",
                            "graph_simulation+failure=B20+dark_share=0.25", "solo"));
    EXPECT_EQ(config.conditions[4].failure, "B20,dark_share=0.25");
    EXPECT_NO_THROW(make_plan(config, {"0.1.0", "1.15.0"}, "/out")) << "the names can be folders";
}

TEST_F(Factors, AndConditionsHaveTitlesThatChangeNoRun) {
    const std::string factors = R"([factors]
condition.failure = ["perfect", "B10"]
)";
    const StudyConfig titled = read(factors + R"([titles]
graph_simulation = "Net"
B10 = "one report in ten"
"graph_simulation+failure=perfect" = "All seen"
)");
    EXPECT_EQ(titled.titles.at("B10"), "one report in ten");
    const Plan plan = make_plan(titled, {"0.1.0", "1.15.0"}, "/out");
    EXPECT_EQ(plan.titles.size(), 3U);
    EXPECT_EQ(plan.manifest, make_plan(read(factors), {"0.1.0", "1.15.0"}, "/out").manifest);
    EXPECT_THAT(problems(factors + "[titles]\ngraph_simulatoin = \"x\"\ngraph_simulation = \"\"\n"),
                AllOf(HasSubstr("titles.graph_simulatoin: is no condition, and no text that a factor gives"),
                      HasSubstr("Did you mean 'graph_simulation'?"), HasSubstr("titles.graph_simulation:")));
}

TEST_F(Factors, WithATitleOfNearlyTheirNameMayBeTheOnesThatAreMisspelt) {
    const StudyConfig config = read("[factors]\ncondition.failure = [\"B10\"]\n[titles]\nB20 = \"x\"\n");
    ASSERT_EQ(config.doubtful_titles.size(), 1U);
    EXPECT_THAT(core::format_problem(config.doubtful_titles[0]),
                AllOf(HasSubstr("titles.B20: is no condition"), HasSubstr("Did you mean 'B10'?")));
}

TEST_F(Factors, MayBeQuotedAsSettingsAre) {
    const StudyConfig quoted = read("[factors]\n\"failure.dark_share\" = [0.1, 0.25]\n");
    const StudyConfig plain = read("[factors]\nfailure.dark_share = [0.1, 0.25]\n");
    EXPECT_EQ(quoted.conditions, plain.conditions);
    EXPECT_THAT(problems("[factors]\n\"failure.dark_shere\" = [0.1]\n"), HasSubstr("dark_share"));
    EXPECT_THAT(problems("[factors]\n\"nothing.lead_s\" = [4]\n"), HasSubstr("'nothing.lead_s' is unknown"));
}

TEST_F(Factors, OfScenariosMakeScenarios) {
    const StudyConfig config = read(R"([factors]
scenario.drivers.speed_factor_mean = [0.9, 1.1]
scenario.density = [1, 2]
loop.policy_period_s = [0.5, 1]
condition.policy = [["dissertation"], ["clear_lane", "preempt_signals"]]
)");
    EXPECT_THAT(names(config.scenarios), testing::Contains("merge+density=2+speed_factor_mean=1.1"));
    ASSERT_EQ(config.scenarios.size(), 4U);
    for (const auto& scenario : config.scenarios) {
        const bool fast = scenario.name.ends_with("speed_factor_mean=1.1");
        EXPECT_DOUBLE_EQ(scenario.drivers.speed_factor_mean, fast ? 1.1 : 0.9);
    }
    EXPECT_EQ(config.conditions.size(), 2U + 4U);
    const auto two = std::ranges::find_if(config.conditions, [](const auto& condition) {
        return condition.name == "graph_simulation+policy=clear_lane.preempt_signals+policy_period_s=1";
    });
    ASSERT_NE(two, config.conditions.end());
    EXPECT_THAT(two->policies, ElementsAre("clear_lane", "preempt_signals"));
    EXPECT_EQ(two->settings.at("loop.policy_period_s"), "1");
}

constexpr const char* two_policies = R"(
[[condition]]
name = "corridor"
policy = ["corridor"]
[[condition]]
name = "green_wave"
policy = "green_wave"
)";

TEST_F(Factors, OfASettingVaryTheConditionsThatHaveIt) {
    const StudyConfig config = read(std::string(two_policies) + R"([factors]
preempt_signals.lead_s = [4, 16]
actuation.hold_cap_s = [30]
)");
    EXPECT_THAT(
        names(config.conditions),
        ElementsAre("baseline", "graph_simulation+hold_cap_s=30", "solo", "corridor+hold_cap_s=30+lead_s=4",
                    "corridor+hold_cap_s=30+lead_s=16", "green_wave+hold_cap_s=30"));
    EXPECT_EQ(config.conditions[4].settings,
              (core::Settings{{"actuation.hold_cap_s", "30"}, {"preempt_signals.lead_s", "16"}}));
    EXPECT_THAT(problems("[factors]\npreempt_signals.lead_s = [4]\n"),
                HasSubstr("is a setting that no condition has"));
    EXPECT_THAT(problems(std::string(two_policies) + "[factors]\npreempt_signals.lead_s = [4, 99]\n"),
                HasSubstr("99 is out of range"));
    EXPECT_THAT(problems(std::string(two_policies) + "[factors]\npreempt_signals.leed_s = [4]\n"),
                HasSubstr("'lead_s'"));
}

TEST_F(Factors, OneAtATimeKeepTheConditionItself) {
    const StudyConfig config = read(std::string(two_policies) + R"([factors]
design = "one_at_a_time"
preempt_signals.lead_s = [4, 16]
green_wave.before_s = [20]
)");
    EXPECT_THAT(names(config.conditions),
                ElementsAre("baseline", "graph_simulation", "solo", "corridor", "corridor+lead_s=4",
                            "corridor+lead_s=16", "green_wave", "green_wave+before_s=20"));
    EXPECT_THAT(problems("[factors]\ndesign = \"some\"\n"), HasSubstr("all_combinations, one_at_a_time"));
}

TEST_F(Factors, OfSeveralSettingsSetThemTogether) {
    const StudyConfig config = read(std::string(two_policies) + R"([factors]
set = [{ "preempt_signals.lead_s" = 4, "clear_lane.horizon_m" = 300 }, { preempt_signals.lead_s = 16 }]
)");
    EXPECT_THAT(names(config.conditions),
                ElementsAre("baseline", "graph_simulation", "solo", "corridor+set=horizon_m_300.lead_s_4",
                            "corridor+set=lead_s_16", "green_wave"));
    EXPECT_EQ(config.conditions[3].settings,
              (core::Settings{{"clear_lane.horizon_m", "300"}, {"preempt_signals.lead_s", "4"}}));
    EXPECT_NO_THROW(make_plan(config, {"0.1.0", "1.15.0"}, "/out")) << "the names can be folders";
    EXPECT_THAT(problems(std::string(two_policies) + "[factors]\nset = [1]\n"),
                HasSubstr("is not a list of settings"));
}

TEST_F(Factors, MayVaryASettingOnce) {
    EXPECT_THAT(
        problems("[factors]\nset = [{\"failure.dark_share\" = 0.1}]\nfailure.dark_share = [0.2, 0.3]\n"),
        HasSubstr("failure.dark_share is varied by another factor too"));
    EXPECT_THAT(problems("[factors]\n\"failure.dark_share\" = [0.1]\nfailure.dark_share = [0.2]\n"),
                HasSubstr("failure.dark_share is varied by another factor too"));
    EXPECT_THAT(problems("[factors]\nset = [{\"failure.dark_share\" = 0.1, failure.dark_share = 0.2}]\n"),
                HasSubstr("failure.dark_share: is set twice"));
    EXPECT_THAT(problems("[factors]\nset = [{\"failure.dark_share\" = 0.1}, {}]\n"),
                HasSubstr("sets nothing"));
}

TEST_F(Factors, OnWhatAnOverrideSetsAreRefusedWithBothPlaces) {
    struct Case {
        const char* override;
        const char* factor;
    };
    for (const Case& one : {Case{"friction = 0.5", "road.friction = [0.3, 0.7]"},
                            Case{"horizon_s = 900", "time.horizon_s = [600, 1200]"},
                            Case{"variant = \"dense\"", "demand.emergency = [1, 2]"},
                            Case{"variant = \"dense\"", "time.warm_up_s = [10, 20]"},
                            Case{"automated_share = 0.5", "demand.human = [20, 40]"},
                            Case{"traffic_kinds = \"car=8,truck=2\"", "kinds.traffic.truck = [0.1, 0.2]"}}) {
        const std::string override(one.override);
        const std::string factor(one.factor);
        const std::string text =
            problems("[overrides]\n" + override + "\n[factors]\nscenario." + factor + "\n");
        EXPECT_THAT(
            text, testing::ContainsRegex("study.toml:8:[0-9]+: factors.scenario." +
                                         factor.substr(0, factor.find(' ')) + ": changes nothing, because "))
            << factor;
        EXPECT_THAT(text, HasSubstr("study.toml:6:1: overrides." + override.substr(0, override.find(' ')) +
                                    " replaces it (allowed: one of the two). Remove the override"));
    }
}

TEST_F(Factors, BesideAnOverrideThatLeavesTheirKeyAreRead) {
    for (const char* const both :
         {"[overrides]\nfriction = 0.5\n[factors]\nscenario.road.speed_factor = [0.7, 0.8]\n",
          "[overrides]\ndensity = 2\n[factors]\nscenario.demand.density = [0.5, 1]\n",
          "[overrides]\nvariant = \"standard\"\n[factors]\nscenario.demand.emergency = [1, 2]\n",
          "[overrides]\nvariant = \"dense\"\n[factors]\nscenario.warm_up_s = [10, 20]\n"}) {
        const StudyConfig config = read(both);
        ASSERT_EQ(config.scenarios.size(), 2U) << both;
        EXPECT_NE(scenario::configuration_hash(config.scenarios[0]),
                  scenario::configuration_hash(config.scenarios[1]))
            << both;
    }
}

TEST_F(Factors, AndAnOverrideOfOneNameAreRefusedUnlessItIsTheUnvariedValue) {
    const std::string overrides = "[overrides]\nfriction = 0.5\n[factors]\nscenario.friction = [0.3, 0.7]\n";
    EXPECT_THAT(
        problems(overrides),
        testing::AllOf(testing::ContainsRegex("study.toml:8:[0-9]+: factors.scenario.friction: replaces "),
                       HasSubstr("study.toml:6:1: overrides.friction (allowed: one of the two)")));
    const StudyConfig config = read(overrides + "design = \"one_at_a_time\"\n");
    ASSERT_EQ(config.scenarios.size(), 3U);
    EXPECT_EQ(config.scenarios[0].road.friction, 0.5);
    EXPECT_EQ(config.scenarios[1].road.friction, 0.3);
}

TEST_F(Factors, OnWhatAScenarioOfItsOwnSetsAreRefused) {
    const std::string icy = "[[scenario]]\nname = \"icy\"\nfrom = \"merge\"\nfriction = 0.3\n[factors]\n";
    EXPECT_THAT(problems(icy + "scenario.road.friction = [0.3, 0.7]\n"),
                testing::AllOf(testing::ContainsRegex(
                                   "study.toml:10:[0-9]+: factors.scenario.road.friction: changes nothing"),
                               HasSubstr("study.toml:8:1: scenario.friction replaces it")));
    EXPECT_THAT(problems(icy + "scenario.friction = [0.3, 0.7]\n"),
                HasSubstr("study.toml:8:1: scenario.friction (allowed"));
}

TEST_F(Factors, TwoOnOneKeyAreRefused) {
    EXPECT_THAT(problems("[factors]\nscenario.road.friction = [0.3, 0.7]\nscenario.friction = [0.4, 0.8]\n"),
                testing::AllOf(testing::ContainsRegex(
                                   "study.toml:6:[0-9]+: factors.scenario.road.friction: is replaced by "),
                               HasSubstr("factors.scenario.friction (allowed: one factor")));
    EXPECT_THAT(problems("[factors]\nscenario.variant = [\"standard\", \"dense\"]\n"
                         "scenario.time.window_s = [100, 200]\n"),
                HasSubstr("factors.scenario.time.window_s: is replaced by another factor"));
    EXPECT_EQ(problems("[factors]\nscenario.variant = [\"standard\"]\nscenario.demand.emergency = [1, 2]\n"),
              "none");
}

TEST_F(Factors, OneAtATimeAreOfScenariosOrOfConditions) {
    EXPECT_THAT(problems("[factors]\ndesign = \"one_at_a_time\"\nscenario.demand.human = [40, 80]\n"
                         "failure.dark_share = [0.1, 0.2]\n"),
                HasSubstr("cannot be varied one at a time beside settings of conditions"));
}

TEST_F(Factors, OfSirensGiveTheBaselineTheSameDrivers) {
    const StudyConfig config = read("[factors]\nsiren.compliance = [0, 1]\n");
    EXPECT_THAT(names(config.conditions),
                ElementsAre("baseline+compliance=0", "baseline+compliance=1", "graph_simulation+compliance=0",
                            "graph_simulation+compliance=1", "solo"));
    for (const std::size_t at : {0U, 1U}) {
        EXPECT_TRUE(experiment::same_environment(config.conditions[at], config.conditions[at + 2]));
        EXPECT_FALSE(experiment::same_environment(config.conditions[at], config.conditions[3 - at]));
    }
    EXPECT_NO_THROW(make_plan(config, {"0.1.0", "1.15.0"}, "/out"));
}

TEST_F(Factors, ConditionsAndSettingsSetTheSame) {
    const StudyConfig by_factor = read(std::string(two_policies) + R"([factors]
preempt_signals.lead_s = [12.0]
failure.dark_share = [0.5]
)");
    const StudyConfig by_condition = read(R"([[condition]]
name = "corridor+dark_share=0.5+lead_s=12"
policy = ["corridor"]
set = { "preempt_signals.lead_s" = 12, failure.dark_share = 0.5 }
)");
    experiment::ConditionSpec varied = by_factor.conditions[3];
    EXPECT_EQ(varied.factors.size(), 2U);
    varied.factors.clear();  // they alone tell where the settings come from
    EXPECT_EQ(varied, by_condition.conditions[3]);
    experiment::ConditionSpec by_hand;
    by_hand.name = by_factor.conditions[3].name;
    by_hand.policies = {"corridor"};
    experiment::set(by_hand, "failure.dark_share", "0.50");
    experiment::set(by_hand, "preempt_signals.lead_s", "12.00");
    EXPECT_EQ(varied, by_hand);
}

TEST_F(Factors, ThatAreUnknownNameTheNearest) {
    EXPECT_THAT(problems("[factors]\nfaliure.dark_share = [0.1]\n"),
                testing::AllOf(HasSubstr("study.toml:6:"), HasSubstr("Did you mean 'failure'?")));
    EXPECT_THAT(problems("[factors]\ncondition.predictr = [\"none\"]\n"), HasSubstr("'predictor'"));
    EXPECT_THAT(problems("[factors]\npredictor = [\"none\"]\n"), HasSubstr("'condition.predictor'"));
    EXPECT_THAT(problems("[factors]\nloop.policy_perod_s = [1]\n"), HasSubstr("'policy_period_s'"));
    EXPECT_THAT(problems("[factors]\nscenario.demand.humn = [1]\n"),
                testing::AllOf(HasSubstr("demand.humn"), HasSubstr("'scenario.demand.human'")));
    EXPECT_THAT(problems("[factors]\nscenario.name.x = [1]\n"), HasSubstr("'name.x' is unknown"));
}

TEST_F(Factors, OfScenariosThatAreUnknownAreNamedOnceWithTheirPlace) {
    const auto message = [&](const std::string& key) {
        return problems("[factors]\nscenario." + key + " = [1, 2]\n");
    };
    EXPECT_THAT(
        message("fricton"),
        testing::AllOf(testing::ContainsRegex("study.toml:6:[0-9]+: factors.scenario.fricton: "),
                       testing::EndsWith("'fricton' is unknown (allowed: overrides and keys of `clearway "
                                         "list scenario-keys`). Did you mean 'scenario.friction'?"),
                       testing::Not(HasSubstr("\n"))));
    EXPECT_THAT(message("demand.humans"), HasSubstr("Did you mean 'scenario.demand.human'?"));
    EXPECT_THAT(message("speed_factor_mean"),
                HasSubstr("Did you mean 'scenario.drivers.speed_factor_mean'?"));
    EXPECT_THAT(message("drivers.friction"), HasSubstr("Did you mean 'scenario.friction'?"));
    EXPECT_THAT(message("flow.share"),
                testing::ContainsRegex("study.toml:6:[0-9]+: factors.scenario.flow.share: 'flow.share' is"));
}

TEST_F(Factors, WithoutValuesOrWithWrongOnesAreRefused) {
    EXPECT_THAT(problems("[factors]\nfailure.dark_share = []\n"), HasSubstr("has no values"));
    EXPECT_THAT(problems("[factors]\nfailure.dark_share = 0.5\n"), HasSubstr("is not a list"));
    EXPECT_THAT(problems("[factors]\nfailure = [\"B5\"]\n"), HasSubstr("'condition.failure'"));
    EXPECT_THAT(problems("[factors]\nloop.policy_period_s = [99]\n"), HasSubstr("99 is out of range"));
    EXPECT_THAT(problems("[factors]\ncondition.traffic_model = [\"warp\"]\n"),
                HasSubstr("\"warp\" is not known"));
    EXPECT_THAT(problems("[factors]\nscenario.demand.human = [-4]\n"),
                testing::AllOf(HasSubstr("-4 is negative"), HasSubstr("set by a factor")));
    EXPECT_THAT(problems("[factors]\nscenario.variant = [\"denser\"]\n"),
                HasSubstr("overrides.variant, set by a factor: \"denser\" is not known"));
}

TEST_F(Factors, AreCountedBeforeTheirCombinationsAreMade) {
    std::string seven = "[factors]\n";
    std::string ten = "[factors]\n";
    for (int factor = 0; factor < 10; ++factor) {
        const std::string line =
            fmt::format("failure.x{} = [1, 2, 3, 4, 5, 6, 7, 8]\n", factor);  // unknown, but that comes later
        if (factor < 7) seven += line;
        ten += line;
    }
    EXPECT_THAT(problems(seven), testing::AllOf(HasSubstr("make 2097152 of each condition"),
                                                HasSubstr("at most 100000 runs"), HasSubstr("--most-runs")));
    EXPECT_THAT(problems(ten), HasSubstr("make 1073741824 of each condition"));
    EXPECT_THAT(problems(ten + "design = \"one_at_a_time\"\n"), testing::Not(HasSubstr("of each")))
        << "81 of them";
    const detail::Factors endless{
        std::vector<detail::Factor>(30, {"loop", "a", "", std::vector<detail::FactorValue>(8)}),
        detail::Design::all_combinations};
    EXPECT_EQ(detail::count_combinations(endless, detail::Subject::conditions),
              std::numeric_limits<std::uint64_t>::max())
        << "8^30";
}

TEST_F(Factors, NeedAConditionToVary) {
    try {
        read_study(folder_.write("study.toml",
                                 "scenarios = [\"merge\"]\nconditions = [\"baseline\", \"solo\"]\n"
                                 "[factors]\ncondition.failure = [\"B5\"]\n"));
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("no condition has failures"));
    }
}

TEST_F(Factors, TwiceTheSameValueIsRefusedByName) {
    EXPECT_THAT(problems("[factors]\nfailure.dark_share = [0.1, 0.3, 0.1]\n"),
                HasSubstr("factors.failure.dark_share: has the level 0.1 twice"));
}

class Precision : public testing::Test {
  protected:
    Precision() { setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1); }
    std::string problems(const std::string& text) {
        try {
            read_study(
                folder_.write("study.toml", "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n" + text));
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }
    support::TemporaryFolder folder_;
};

TEST_F(Precision, BeginsWithFhwasLeastAndKeepsItsCap) {
    const StudyConfig config = read_study(
        folder_.write("study.toml",
                      "scenarios = [\"merge\"]\nconditions = [\"baseline\"]\n"
                      "[precision]\nmetric = \"waiting_time_s\"\nhalf_width = 0.5\nat_most = 40\n"));
    EXPECT_EQ(config.replications, 10U);
    ASSERT_TRUE(config.precision);
    EXPECT_EQ(config.precision->metric, "waiting_time_s");
    EXPECT_DOUBLE_EQ(config.precision->half_width, 0.5);
    EXPECT_EQ(config.precision->at_most, 40U);
}

TEST_F(Precision, ThatCannotBeMeantIsRefused) {
    EXPECT_THAT(problems("[precision]\nhalf_width = 0\n"), HasSubstr("0 is not positive"));
    EXPECT_THAT(problems("[precision]\nhalf_width = nan\n"), HasSubstr("is not positive"));
    EXPECT_THAT(problems("[precision]\nat_most = 20\n"), HasSubstr("half_width: is missing"));
    EXPECT_THAT(problems("[precision]\nhalf_width = 1\nat_most = 3\n"), HasSubstr("10 to"));
    EXPECT_THAT(problems("[precision]\nhalf_width = 1\nmetric = \"emergency_travel_time\"\n"),
                HasSubstr("'emergency_travel_time_s'"));
    EXPECT_THAT(problems("replications = 5\n[precision]\nhalf_width = 1\n"),
                HasSubstr("replications: is given together with [precision]"));
}

}  // namespace
}  // namespace clearway::study
