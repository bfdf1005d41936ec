#include "pipeline/decision_chain.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "experiment/equipped_signals.hpp"
#include "prediction/predictor.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::pipeline {
namespace {

/// Decisions of a condition on a scene that drives on for `duration_s`.
std::vector<traffic::Lease> decided(const experiment::ConditionSpec& condition, support::Scene& scene,
                                    double duration_s = 3.0) {
    DecisionChain chain(condition, {.network = scene.network()});
    std::vector<traffic::Lease> leases;
    for (int step = 0; step < duration_s * 2.0; ++step) {
        chain.observe(scene.snapshot(), scene.roster());
        if (chain.decision_is_due()) chain.decide();
        leases.insert(leases.end(), chain.leases().begin(), chain.leases().end());
        scene.pass(core::Seconds(0.5));
    }
    return leases;
}

std::vector<std::string> described(const std::vector<traffic::Lease>& leases) {
    std::vector<std::string> lines;
    for (const traffic::Lease& lease : leases)
        lines.push_back(fmt::format("{} {} {}", lease.policy, lease.action.index(), lease.reason));
    return lines;
}

constexpr const char* before_red = R"(
        10 m per cell, limit 10 m/s, speed 1 m/s
        ..h..a...|r....h
        ..e......|r.....
    )";
constexpr const char* before_green = R"(
        10 m per cell, limit 10 m/s, speed 1 m/s
        ..h..a...|G....h
        ..e......|G.....
    )";

class HiddenSignals : public ::testing::TestWithParam<const char*> {};

TEST_P(HiddenSignals, ChangeNoDecisionAtTheSignals) {
    for (const char* const drawing : {before_red, before_green}) {
        experiment::ConditionSpec condition;
        condition.policies = {GetParam()};
        support::Scene known(drawing);
        support::Scene hidden(drawing);
        condition.failure = "report_interval_s=1";
        const std::vector<std::string> expected = described(decided(condition, known));
        condition.failure = "S0";
        EXPECT_EQ(described(decided(condition, hidden)), expected) << drawing;
    }
}

INSTANTIATE_TEST_SUITE_P(Policies, HiddenSignals,
                         ::testing::Values("red_privilege", "recover_signals", "preempt_signals",
                                           "green_wave", "corridor"));

TEST(RedPrivilege, SeesItsSignalThoughReportsDoNotTell) {
    experiment::ConditionSpec condition;
    condition.failure = "S0";
    condition.policies = {"red_privilege"};
    support::Scene red(before_red);
    EXPECT_FALSE(decided(condition, red).empty());
    support::Scene green(before_green);
    EXPECT_TRUE(decided(condition, green).empty());
}

TEST(DecisionChain, GivesLinksToPoliciesThatReadThemWhateverOthersWant) {
    const auto believed_links = [](const char* policy, const core::Settings& settings) {
        experiment::ConditionSpec condition;
        condition.policies = {policy};
        condition.settings = settings;
        support::Scene scene("10 m per cell\n..e.a..a....\n....h.......");
        DecisionChain chain(condition, {.network = scene.network()});
        chain.observe(scene.snapshot(), scene.roster());
        chain.decide(prediction::Want::places);
        return chain.belief().link_count();
    };
    EXPECT_GT(believed_links("dissertation", {}), 0U);
    EXPECT_GT(believed_links("clear_lane", {{"clear_lane.ask", "linked"}}), 0U);
    EXPECT_EQ(believed_links("clear_lane", {}), 0U) << "it reads places alone";
}

class EquippedSignals : public ::testing::TestWithParam<const char*> {
  protected:
    /// Targets of leases to signals, and the number of messages to signals.
    static std::pair<std::set<std::uint32_t>, std::uint64_t> asked(const std::string& equipped) {
        experiment::ConditionSpec condition;
        condition.policies = {GetParam()};
        if (!equipped.empty()) condition.settings["actuation.equipped"] = equipped;
        support::Scene scene(before_red);
        DecisionChain chain(condition, {.network = scene.network()});
        std::set<std::uint32_t> signals;
        for (int step = 0; step < 6; ++step) {
            chain.observe(scene.snapshot(), scene.roster());
            if (chain.decision_is_due()) chain.decide();
            for (const traffic::Lease& lease : chain.leases()) {
                if (const auto* const signal = std::get_if<core::SignalIndex>(&lease.target))
                    signals.insert(signal->value);
            }
            scene.pass(core::Seconds(0.5));
        }
        return {signals, chain.signal_requests().sent};
    }
};

TEST_P(EquippedSignals, AloneTakePartInPolicies) {
    const support::Scene scene(before_red);
    const std::string id = scene.network().signals().front().id;
    EXPECT_TRUE(!asked("").first.empty() || asked("").second > 0) << "the scene has something to ask for";
    EXPECT_EQ(asked(id), asked(""));
    EXPECT_EQ(asked("all"), asked(""));
    EXPECT_TRUE(asked("none").first.empty());
    EXPECT_EQ(asked("none").second, 0U);
}

INSTANTIATE_TEST_SUITE_P(Policies, EquippedSignals,
                         ::testing::Values("recover_signals", "preempt_signals", "green_wave", "corridor"));

TEST(EquippedSignalsOfACondition, CanBeNamedByTheirNumbers) {
    experiment::ConditionSpec condition;
    condition.settings["actuation.equipped"] = "#1";
    const support::Scene scene(before_red);
    const std::vector<bool> equipped = experiment::equipped_signals(condition, scene.network());
    ASSERT_FALSE(equipped.empty());
    EXPECT_TRUE(equipped[0]);
    EXPECT_EQ(std::ranges::count(equipped, true), 1);
}

TEST(EquippedSignalsOfACondition, CannotBeNamedTwiceInTwoWays) {
    experiment::ConditionSpec condition;
    const support::Scene scene(before_red);
    condition.settings["actuation.equipped"] = scene.network().signals().front().id + ",#1";
    EXPECT_THROW(experiment::equipped_signals(condition, scene.network()), core::InputError);
}

TEST(EquippedSignalsOfACondition, MustBeInTheNetwork) {
    experiment::ConditionSpec condition;
    condition.name = "mine";
    condition.policies = {"corridor"};
    const support::Scene scene(before_red);
    condition.settings["actuation.equipped"] = scene.network().signals().front().id + "x";
    try {
        DecisionChain(condition, {.network = scene.network()});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("condition mine: actuation.equipped"),
                                   testing::HasSubstr("has no signal"), testing::HasSubstr("Did you mean")));
    }
}

class UnknownParts : public ::testing::TestWithParam<const char*> {};

TEST_P(UnknownParts, AreNoTroubleToAnyPredictor) {
    for (const std::string& predictor : prediction::predictors().names()) {
        experiment::ConditionSpec condition;
        condition.failure = GetParam();
        condition.predictor = predictor;
        condition.policies = {"clear_lane"};
        support::Scene scene(R"(
            10 m per cell, limit 10 m/s, speed 4 m/s
            ..h..a...|G.h..a..|r....h
            ..e..h...|G...h...|r.....
        )");
        DecisionChain chain(condition, {.network = scene.network()});
        std::size_t believed = 0;
        for (int second = 0; second < 20; ++second) {
            chain.observe(scene.snapshot(), scene.roster());
            chain.decide();
            believed += chain.belief().vehicles.size();
            scene.pass(core::Seconds(1.0));
        }
        EXPECT_GT(believed, 60u) << predictor;
    }
}

INSTANTIATE_TEST_SUITE_P(Failures, UnknownParts,
                         ::testing::Values("S0", "R0", "R50", "D5M", "mixed", "S0,dark_share=0.5",
                                           "mixed,signals_known=0,exits=unknown"));

experiment::ConditionSpec oracle(const core::Settings& settings = {}) {
    experiment::ConditionSpec condition;
    condition.predictor = "oracle";
    condition.settings = settings;
    return condition;
}

TEST(Oracle, ObservesWhatSensorsWithoutFaultsWould) {
    EXPECT_EQ(observed_failure(oracle()), failures::failure_from("perfect"));
    const failures::FailureConfig late =
        observed_failure(oracle({{"oracle.age_s", "3"}, {"oracle.place_error_m", "5"}}));
    EXPECT_EQ(late, failures::failure_from("report_interval_s=0.1,latency_s=3,position_sigma_m=5"));
    experiment::ConditionSpec with_channel = oracle();
    with_channel.failure = "perfect,request_propagation=sharp";
    EXPECT_EQ(observed_failure(with_channel), failures::failure_from(with_channel.failure));
    with_channel.failure =
        "perfect,signal_request_propagation=los,signal_request_range_m=70,request_propagation=nlos,"
        "request_hops=3,emergency_dark=no";
    EXPECT_EQ(observed_failure(with_channel), failures::failure_from(with_channel.failure));
    with_channel.failure = "mixed,signals_known=0";
    EXPECT_EQ(observed_failure(with_channel), failures::failure_from("perfect")) << "whatever is asked for";
    experiment::ConditionSpec honest;
    honest.failure = "B10";
    EXPECT_EQ(observed_failure(honest), failures::failure_from("B10"));
}

TEST(Oracle, BelievesThePastAsItWas) {
    support::Scene scene("10 m per cell, limit 20 m/s, speed 10 m/s\ne...a....................\n");
    DecisionChain chain(oracle({{"oracle.age_s", "2"}}), {.network = scene.network()});
    const auto observe = [&] {
        chain.observe(scene.snapshot(), scene.roster());
        chain.decide();
    };
    const core::VehicleKey ahead = scene.key("a1");
    const float at_first_m = scene.snapshot().x_m[scene.row("a1")];
    for (int step = 0; step < 4; ++step) {
        observe();
        EXPECT_EQ(chain.belief().find(ahead), nullptr) << "nothing is 2 s old yet";
        scene.pass(core::Seconds(0.5));
    }
    observe();
    ASSERT_NE(chain.belief().find(ahead), nullptr);
    EXPECT_FLOAT_EQ(chain.belief().find(ahead)->state.x_m, at_first_m);
    EXPECT_FLOAT_EQ(chain.belief().find(ahead)->age_s, 2.0F);
    EXPECT_FLOAT_EQ(scene.snapshot().x_m[scene.row("a1")], at_first_m + 20.0F);
}

}  // namespace
}  // namespace clearway::pipeline
