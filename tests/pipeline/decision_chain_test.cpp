#include "pipeline/decision_chain.hpp"

#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>

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

class UnknownParts : public ::testing::TestWithParam<const char*> {};

TEST_P(UnknownParts, AreNoTroubleToAnyPredictor) {
    for (const std::string& predictor : prediction::predictor_names()) {
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

}  // namespace
}  // namespace clearway::pipeline
