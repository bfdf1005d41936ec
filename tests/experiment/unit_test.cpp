#include "experiment/unit.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "experiment/condition_json.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::experiment {
namespace {

UnitSpec example() {
    UnitSpec unit;
    unit.scenario = "city";
    unit.scenario_file = "/out/scenarios/city/scenario.toml";
    unit.network_folder = "/out/scenarios/city/network";
    unit.study_seed = 18446744073709551615U;
    unit.replication = 7;
    unit.engine = Engine::sublane;
    unit.recording = StepRecording::on;
    ConditionSpec condition;
    condition.name = "b10";
    condition.failure = "B10,mean_outage_s=20,detection=range";
    condition.predictor = "dead_reckoning";
    condition.policies = {"dissertation", "preempt"};
    condition.engine = Engine::sublane;
    condition.safety_checks = traffic::SafetyChecks::off;
    condition.settings = {{"loop.policy_period_s", "1"}, {"dissertation.ahead_m", "80"}};
    condition.model_file = "/models/net.weights";
    condition.model_hash = "00ff";
    condition.bluelight = traffic::BlueLight::on;
    unit.conditions = {condition, ConditionSpec{}};
    unit.limits = {.wall_s = 12.5, .memory_mib = 300};
    unit.output = "/out";
    return unit;
}

TEST(UnitSpec, SurvivesTheWayThroughAFile) {
    const support::TemporaryFolder folder;
    EXPECT_EQ(read_unit(folder.write("unit.json", to_json(example()))), example());
}

TEST(UnitSpec, WithNothingSetIsTheSameTextAsBeforeThereWereSettings) {
    ConditionSpec condition;
    condition.name = "b10";
    condition.failure = "B10";
    condition.policies = {"corridor"};
    EXPECT_EQ(to_json(condition).dump(),
              R"({"name":"b10","failure":"B10","predictor":"none","parts":["corridor"],)"
              R"("engine":"standard","safety_checks":"on"})");
    condition.settings = {{"loop.policy_period_s", "1"}};
    EXPECT_EQ(to_json(condition)["loop_settings"].dump(), R"({"policy_period_s":"1"})");
    EXPECT_FALSE(to_json(condition).contains("settings"));
}

TEST(UnitSpec, ReportsEveryProblemOfAFileAtOnce) {
    const support::TemporaryFolder folder;
    const auto file = folder.write("unit.json", R"({"scenario": 3, "engine": "warp", "conditions": {}})");
    try {
        read_unit(file);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("scenario: is of another type"));
        EXPECT_THAT(error.what(), testing::HasSubstr("\"warp\" is not known"));
        EXPECT_THAT(error.what(), testing::HasSubstr("output: is missing"));
        EXPECT_THAT(error.what(), testing::HasSubstr("conditions: is of another type"));
    }
    EXPECT_THROW(read_unit(folder.write("half.json", to_json(example()).substr(0, 90))), core::InputError);
}

}  // namespace
}  // namespace clearway::experiment
