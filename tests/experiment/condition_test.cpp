#include <gmock/gmock.h>

#include "experiment/condition_json.hpp"

namespace clearway::experiment {
namespace {

TEST(ConditionSpec, names_its_settings_only_where_there_are_any) {
    ConditionSpec condition;
    condition.name = "b10";
    condition.failure = "B10";
    condition.policies = {"corridor"};
    EXPECT_EQ(to_json(condition).dump(),
              R"({"name":"b10","failure":"B10","predictor":"none","policies":["corridor"],)"
              R"("traffic_model":"standard","safety_checks":"on"})");
    condition.settings = {{"loop.policy_period_s", "1"}};
    EXPECT_EQ(to_json(condition)["settings"].dump(), R"({"loop.policy_period_s":"1"})");
}

}  // namespace
}  // namespace clearway::experiment
