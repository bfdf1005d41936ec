#include <gmock/gmock.h>

#include "experiment/condition_json.hpp"
#include "experiment/condition_words.hpp"
#include "experiment/conditions.hpp"
#include "support/message_of.hpp"

namespace clearway::experiment {
namespace {

TEST(ConditionSpec, is_stored_with_its_settings_where_it_has_any) {
    ConditionSpec condition;
    condition.name = "b10";
    condition.failure = "B10";
    condition.policies = {"corridor"};
    EXPECT_EQ(to_json(condition).dump(),
              R"({"name":"b10","failure":"B10","predictor":"none","traffic_model":"standard",)"
              R"("safety_checks":"on","bluelight":"off","rerouting_s":0.0,"rerouting_signal_penalty":0.0,)"
              R"("dispatch":"free_flow","policies":["corridor"]})");
    condition.settings = {{"loop.policy_period_s", "1"}};
    EXPECT_EQ(to_json(condition)["settings"].dump(), R"({"loop.policy_period_s":"1"})");
    std::vector<core::Problem> problems;
    EXPECT_EQ(condition_from(to_json(condition), "here", problems), condition);
    EXPECT_TRUE(problems.empty());
}

TEST(PolicyWords, say_what_policies_do_and_a_combination_by_its_parts) {
    ConditionSpec condition;
    EXPECT_EQ(policy_words(condition), "");
    condition.policies = {"preempt_signals"};
    EXPECT_EQ(policy_words(condition), "green for the emergency vehicle's approach on its arrival");
    condition.policies = {"corridor"};
    EXPECT_THAT(policy_words(condition), testing::HasSubstr("on its arrival; gives green time back"));
    condition.policies = {"preempt_signals", "/home/mine.py:Green@0123456789abcdef0123456789abcdef"};
    EXPECT_EQ(policy_words(condition), "");
}

TEST(FailureWords, TellPresetsInWordsAndFieldsAsTheyStand) {
    ConditionSpec condition;
    EXPECT_EQ(failure_words(condition), "") << "nothing fails";
    condition.failure = "Q50,range_150m";
    EXPECT_EQ(failure_words(condition),
              "50 % of the messages between EVs and signals lost; half of the signals at 150 m hear EVs, in "
              "line of "
              "sight");
    condition.failure = "B10,dark_share=0.5";
    EXPECT_EQ(failure_words(condition), "outages of 10 s on average, dark 30 % of the time; dark_share=0.5");
    EXPECT_FALSE(loses_no_request(condition)) << "asks for nothing";
    condition.policies = {"preempt_signals"};
    EXPECT_TRUE(loses_no_request(condition));
    for (const char* const failure : {"Q50", "B10,range_150m", "perfect", "B10,dark_commands=lost"}) {
        condition.failure = failure;
        EXPECT_FALSE(loses_no_request(condition)) << failure;
    }
}

TEST(FailureWords, KnowPoliciesThatSendNoMessagesWhereMessagesAreLost) {
    ConditionSpec condition;
    condition.policies = {"check_in_out", "clear_lane"};
    condition.failure = "B10";
    EXPECT_EQ(unsent_words(condition), "");
    condition.failure = "B10,Q50";
    EXPECT_EQ(unsent_words(condition),
              "check_in_out sends no messages, so those that this failure loses stand for nothing");
    for (const char* const sends : {"corridor", "/home/mine.py:Green@0123456789abcdef0123456789abcdef"}) {
        condition.policies = {"check_in_out", sends};
        EXPECT_EQ(unsent_words(condition), "") << "the other one is judged";
    }
}

TEST(BuiltInConditions, AreNotTheirPartsWhoseOptionIsNamed) {
    const auto refusal = [](const std::string& name, const std::string& where) {
        return support::message_of([&] { built_in_condition(name, where); });
    };
    using ::testing::HasSubstr;
    EXPECT_THAT(refusal("navigate", "--condition"), HasSubstr("Use --policy navigate"));
    EXPECT_THAT(refusal("dead_reckoning", "--condition"), HasSubstr("Use --predictor dead_reckoning"));
    EXPECT_THAT(refusal("B10", "--condition"), HasSubstr("Use --failure B10"));
    EXPECT_THAT(refusal("navigate", "my.toml: conditions"),
                HasSubstr("Use [[condition]] with policy = [\"navigate\"], in Python Condition(NAME"));
    EXPECT_THAT(refusal("corridr", "--condition"), HasSubstr("Did you mean 'corridor'?"));
}

}  // namespace
}  // namespace clearway::experiment
