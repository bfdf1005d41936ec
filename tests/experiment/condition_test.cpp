#include <gmock/gmock.h>

#include "experiment/condition_json.hpp"

namespace clearway::experiment {
namespace {

TEST(ConditionSpec, with_nothing_set_is_the_same_text_as_before_there_were_settings) {
    ConditionSpec condition;
    condition.name = "b10";
    condition.failure = "B10";
    condition.policies = {"corridor"};
    EXPECT_EQ(to_json(condition).dump(),
              R"({"name":"b10","failure":"B10","predictor":"none","policies":["corridor"],)"
              R"("traffic_model":"standard","safety_checks":"on"})");
    condition.settings = {{"loop.policy_period_s", "1"}};
    EXPECT_EQ(to_json(condition)["loop_settings"].dump(), R"({"policy_period_s":"1"})");
    EXPECT_FALSE(to_json(condition).contains("settings"));
}

}  // namespace
}  // namespace clearway::experiment
