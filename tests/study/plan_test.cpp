#include "study/plan.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "experiment/conditions.hpp"
#include "study/detail/situation.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study {
namespace {

using experiment::TrafficModel;

StudyConfig example() {
    StudyConfig config;
    config.replications = 2;
    for (const char* name : {"alpha", "beta"})
        config.scenarios.emplace_back().name = name;
    for (const experiment::BuiltInCondition& known : experiment::built_in_conditions())
        config.conditions.push_back(known.condition);
    return config;
}

Plan plan_of(const StudyConfig& config) {
    return make_plan(config, {"0.1.0", "1.15.0"}, "/out");
}

std::string problems_of(const StudyConfig& config) {
    try {
        plan_of(config);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(Plan, HasOneUnitPerReplicationScenarioAndTrafficModel) {
    const Plan plan = plan_of(example());
    std::vector<std::string> names;
    for (const PlannedUnit& unit : plan.units)
        names.push_back(unit.name);
    EXPECT_THAT(names,
                testing::ElementsAre("alpha-00000-standard", "alpha-00000-free_flow", "beta-00000-standard",
                                     "beta-00000-free_flow", "alpha-00001-standard", "alpha-00001-free_flow",
                                     "beta-00001-standard", "beta-00001-free_flow"));
    EXPECT_EQ(plan.run_count(), 2U * 2U * 9U);
    EXPECT_EQ(plan.units[0].unit.conditions.size(), 8U);
    EXPECT_EQ(plan.units[1].unit.conditions.size(), 1U);
    EXPECT_EQ(plan.units[1].unit.traffic_model, TrafficModel::free_flow);
    EXPECT_EQ(plan.units[0].unit.network_folder, "/out/scenarios/alpha/network");
}

TEST(Plan, OfBaselinesHasThemAlone) {
    StudyConfig config = example();
    config.titles["corridor"] = "Green";
    config.precision.emplace();
    const StudyConfig baselines = baselines_of(config, 5);
    EXPECT_EQ(baselines.name, "study-baselines");
    EXPECT_FALSE(baselines.precision);
    const Plan plan = plan_of(baselines);
    EXPECT_EQ(plan.run_count(), 5U * 2U) << "neither solo nor a condition that acts";
    ASSERT_EQ(plan.manifest.conditions.size(), 1U);
    EXPECT_EQ(plan.manifest.conditions[0].name, "baseline");
    EXPECT_EQ(plan.manifest.study_seed, config.seed);
}

TEST(Plan, WithMoreRunsThanAllowedIsRefusedWithTheNumbers) {
    StudyConfig config = example();
    config.most_runs = 2 * 2 * 9 - 1;
    EXPECT_THAT(problems_of(config),
                testing::AllOf(testing::HasSubstr("2 scenarios x 9 conditions x 2 replications, 36 runs"),
                               testing::HasSubstr("at most 35 runs"), testing::HasSubstr("--most-runs")));
    ++config.most_runs;
    EXPECT_EQ(plan_of(config).run_count(), config.most_runs);
    config.replications = std::numeric_limits<std::uint32_t>::max();
    EXPECT_THAT(problems_of(config), testing::HasSubstr("77309411310 runs"));
}

TEST(Plan, CoversTheRunsOfTheManifestExactly) {
    const Plan plan = plan_of(example());
    std::vector<experiment::RunKey> runs;
    for (const PlannedUnit& planned : plan.units)
        for (const experiment::ConditionSpec& condition : planned.unit.conditions)
            runs.push_back({planned.unit.scenario, condition.name, planned.unit.replication});
    std::ranges::sort(runs);
    EXPECT_EQ(runs, plan.manifest.runs());
}

TEST(Plan, RefusesNamesThatAreTwiceOrNoFolders) {
    StudyConfig config = example();
    config.scenarios[1].name = "alpha";
    config.conditions[1].name = "../up";
    EXPECT_THAT(problems_of(config), testing::AllOf(testing::HasSubstr("\"alpha\" is used twice"),
                                                    testing::HasSubstr("a copied folder keeps `name`"),
                                                    testing::HasSubstr("\"../up\" cannot be the name")));
}

TEST(Plan, RefusesAConditionThatTakesTheNameOfABuiltInOne) {
    StudyConfig config = example();
    config.conditions[1].failure = "B10";
    EXPECT_THAT(problems_of(config),
                testing::HasSubstr("\"corridor\" is the name of a built-in condition, and this is another"));
}

TEST(Plan, RefusesAPolicyWithoutABaselineOfItsTrafficModel) {
    StudyConfig config = example();
    config.conditions[1].name = "corridor_sublane";
    config.conditions[1].traffic_model = TrafficModel::sublane;
    EXPECT_THAT(problems_of(config), testing::HasSubstr("has no baseline with traffic model \"sublane\""));
    experiment::ConditionSpec baseline;
    baseline.name = "baseline_sublane";
    baseline.traffic_model = TrafficModel::sublane;
    config.conditions.push_back(baseline);
    EXPECT_EQ(problems_of(config), "none");
}

TEST(Plan, TellsOnceThatConditionsHaveNoBaseline) {
    StudyConfig config = example();
    const experiment::ConditionSpec one =
        *std::ranges::find_if(config.conditions, &experiment::ConditionSpec::acts);
    config.conditions.clear();
    for (const char* const name : {"first", "second", "third", "fourth"}) {
        config.conditions.push_back(one);
        config.conditions.back().name = name;
    }
    config.titles = {{"second", "Ours"}};
    const std::string told = problems_of(config);
    EXPECT_THAT(told, testing::HasSubstr("condition first; Ours; and 2 more: has no baseline"));
    EXPECT_EQ(told.find("baseline with"), told.rfind("baseline with"));
}

TEST(Plan, TakesNoConditionWithABluelightForABaseline) {
    StudyConfig config = example();
    experiment::ConditionSpec opponent;
    opponent.name = "bluelight_sublane";
    opponent.traffic_model = TrafficModel::sublane;
    opponent.bluelight = traffic::BlueLight::on;
    config.conditions.push_back(opponent);
    EXPECT_THAT(problems_of(config), testing::HasSubstr("has no baseline with traffic model \"sublane\""));
}

TEST(Plan, StartsSumoAnewForAnotherPenaltyOfSignals) {
    StudyConfig config = example();
    for (const double penalty : {0.0, 1.0}) {
        experiment::ConditionSpec device;
        device.name = fmt::format("device_{:g}", penalty);
        device.rerouting_s = 30.0;
        device.rerouting_signal_penalty = penalty;
        config.conditions.push_back(device);
    }
    const Plan plan = plan_of(config);
    std::vector<std::string> with_penalty;
    for (const PlannedUnit& planned : plan.units) {
        for (const experiment::ConditionSpec& condition : planned.unit.conditions) {
            EXPECT_EQ(experiment::process_of(condition),
                      experiment::process_of(planned.unit.conditions.front()));
            if (condition.name == "device_1") with_penalty.push_back(planned.name);
            if (condition.name != "device_0") continue;
            EXPECT_EQ(planned.name.find("penalty"), std::string::npos);
        }
    }
    EXPECT_THAT(with_penalty,
                testing::ElementsAre("alpha-00000-standard-penalty-1", "beta-00000-standard-penalty-1",
                                     "alpha-00001-standard-penalty-1", "beta-00001-standard-penalty-1"));
}

TEST(Plan, RefusesAnEmptyStudy) {
    StudyConfig config;
    config.replications = 0;
    EXPECT_THAT(problems_of(config),
                testing::AllOf(testing::HasSubstr("no scenario"), testing::HasSubstr("no condition"),
                               testing::HasSubstr("replications")));
}

TEST(Plan, RefusesDrivingBetweenLanesWithoutTheSublaneModel) {
    StudyConfig config = example();
    config.scenarios[1].privilege.between_lanes = 1;
    EXPECT_THAT(problems_of(config), testing::AllOf(testing::HasSubstr("condition corridor, scenario beta"),
                                                    testing::HasSubstr("\"standard\" cannot show"),
                                                    testing::HasSubstr("--traffic-model sublane")));
}

/// What is wrong when a policy runs in a scenario of this name, changed by `change`.
std::string problems_on_the_road(const char* scenario, const char* policy, TrafficModel model,
                                 const std::function<void(scenario::ScenarioConfig&)>& change) {
    scenario::ScenarioConfig config = scenario::load(scenario);
    change(config);
    experiment::ConditionSpec condition;
    condition.name = policy;
    condition.policies = {policy};
    condition.traffic_model = model;
    std::vector<core::Problem> problems;
    detail::check_roads({condition}, config, problems);
    return problems.empty() ? "none" : core::InputError(problems).what();
}

TEST(Situation, RefusesAPolicyThatNeedsAShoulderWhereThereIsNone) {
    const auto as_it_is = [](scenario::ScenarioConfig&) {};
    EXPECT_THAT(
        problems_on_the_road("merge", "pull_over", TrafficModel::standard, as_it_is),
        testing::AllOf(testing::HasSubstr("condition pull_over, scenario merge"),
                       testing::HasSubstr("pull_over needs a shoulder"), testing::HasSubstr("pull_aside")));
    EXPECT_EQ(problems_on_the_road("rural", "pull_over", TrafficModel::standard, as_it_is), "none");
}

TEST(Situation, RefusesWhoAnswersCallsWhereNobodyCalls) {
    experiment::ConditionSpec condition;
    condition.name = "usual";
    std::vector<scenario::ScenarioConfig> scenarios(2);
    const auto problems_with = [&]() -> std::string {
        std::vector<core::Problem> problems;
        detail::check_calls({condition}, scenarios, problems);
        return problems.empty() ? "none" : core::InputError(problems).what();
    };
    EXPECT_EQ(problems_with(), "none");
    condition.dispatch = experiment::Dispatch::believed;
    EXPECT_THAT(problems_with(), testing::HasSubstr("condition usual: dispatch: has no effect"));
    condition.settings["loop.units_tried"] = "2";
    EXPECT_THAT(problems_with(), testing::HasSubstr("condition usual: loop.units_tried: has no effect"));
    scenarios[1].calls.emplace_back();
    EXPECT_EQ(problems_with(), "none") << "one scenario with calls is enough";
}

TEST(Situation, RefusesMeanTimesThatTheScenarioDoesNotNameOrThatAreOfTheStudysOwnDays) {
    const support::TemporaryFolder folder;
    experiment::ConditionSpec condition;
    condition.name = "usual";
    condition.policies = {"navigate"};
    const auto problems_with = [&](const std::string& file, std::uint64_t seed) -> std::string {
        scenario::ScenarioConfig config;
        config.name = "town";
        config.network.mean_times = file;
        config.folder = folder.path();
        std::vector<core::Problem> problems;
        detail::check_mean_times({condition}, config, seed, problems);
        return problems.empty() ? "none" : core::InputError(problems).what();
    };
    EXPECT_EQ(problems_with("", 1), "none");
    condition.settings["navigate.prior"] = "mean_times";
    EXPECT_THAT(problems_with("", 1), testing::AllOf(testing::HasSubstr("condition usual, scenario town"),
                                                     testing::HasSubstr("clearway scenario mean-times")));
    folder.write(
        "times.csv",
        "# clearway mean times 1: network abc, study seed 77, runs 10, edges 1\nedge,vehicles,time_s\n"
        "a,5,8\n");
    EXPECT_EQ(problems_with("times.csv", 1), "none");
    EXPECT_THAT(problems_with("times.csv", 77), testing::HasSubstr("which is that of this study"));
}

TEST(Situation, RefusesAnEmergencyVehicleThatIsWiderThanTheGapBetweenTwoLanes) {
    const auto engine = [](scenario::ScenarioConfig& config) {
        config.privilege.between_lanes = 1;
        config.emergency_kinds = {.ambulance = 0.0, .fire_engine = 1.0};
    };
    EXPECT_THAT(problems_on_the_road("merge", "rescue_lane", TrafficModel::sublane, engine),
                testing::AllOf(testing::HasSubstr("2.5 m of fire_engine and 0.4 m of margin"),
                               testing::HasSubstr("at most 2.80 m"), testing::HasSubstr("--emergency-kinds"),
                               testing::HasSubstr("[[emergency_trip]]")));
    const auto ambulance = [](scenario::ScenarioConfig& config) { config.privilege.between_lanes = 1; };
    EXPECT_EQ(problems_on_the_road("merge", "rescue_lane", TrafficModel::sublane, ambulance), "none");
}

}  // namespace
}  // namespace clearway::study
