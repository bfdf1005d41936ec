// The truth, spoiled by settings.
#include "prediction/oracle.hpp"

#include <gtest/gtest.h>

#include "support/ascii_scene.hpp"

namespace clearway::prediction {
namespace {

constexpr const char* busy = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    a.h.a.hh.a..e.h.a.a.+hh.a..h.e.a.h..........................
    .h.a.ha.e.h..a.h.h.a+.a..h.a.hh.a...........................
)";

std::size_t links_of(const OracleConfig& config, double time_s, std::uint64_t seed = 1) {
    const support::Scene scene(busy);
    traffic::Observation observation = support::perfect_observation(scene);
    observation.time = core::Seconds(time_s);
    PredictorContext context{scene.network(), {}, ""};
    context.random = core::KeyedRandom(core::StudySeed{seed}, core::Replication{});
    traffic::BelievedGraph belief;
    make_oracle(context, config)->predict(observation, belief);
    return belief.link_count();
}

/// Over moments 50 s apart, which differ in their spells.
double mean_links(const OracleConfig& config) {
    double sum = 0.0;
    for (int moment = 0; moment < 200; ++moment)
        sum += static_cast<double>(links_of(config, 100.0 + 50.0 * moment));
    return sum / 200.0;
}

TEST(Oracle, KeepsTheShareOfTheTrueLinksThatItIsToldTo) {
    const auto all = static_cast<double>(links_of({}, 100.0));
    ASSERT_GT(all, 30.0);
    EXPECT_NEAR(mean_links({.links_kept = 0.7}), 0.7 * all, 0.03 * all);
    EXPECT_NEAR(mean_links({.links_kept = 0.05}), 0.05 * all, 0.02 * all);
    EXPECT_EQ(links_of({.links_kept = 0.0}, 100.0), 0u);
}

TEST(Oracle, AddsTheShareOfFalseLinksThatItIsToldTo) {
    const support::Scene scene(busy);
    const auto within = [&](double radius_m) {
        return static_cast<double>(support::perfect_belief(scene, {.radius_m = radius_m}).link_count());
    };
    const double all = within(50.0);
    const double candidates = within(candidate_reach_m({}));
    ASSERT_GT(candidates, 2.0 * all);
    EXPECT_NEAR(mean_links({.false_links = 0.2}), all + 0.2 * (candidates - all), 0.04 * candidates);
}

TEST(Oracle, SpoilsLinksInSpellsThatLastAndAreTheSameForEveryCondition) {
    const OracleConfig config{.links_kept = 0.5};
    EXPECT_EQ(links_of(config, 100.0), links_of(config, 100.5)) << "within a second nothing changes";
    EXPECT_EQ(links_of(config, 100.0), links_of(config, 100.0));
    EXPECT_NE(links_of(config, 100.0, 1), links_of(config, 100.0, 2)) << "another seed";
}

TEST(Oracle, IsTheOnlyPredictorThatKnowsTheTruth) {
    for (const std::string& name : predictors().names())
        EXPECT_EQ(knows_truth(name), name == "oracle");
    EXPECT_NE(title_of("oracle").find("knows the truth"), std::string::npos);
}

}  // namespace
}  // namespace clearway::prediction
