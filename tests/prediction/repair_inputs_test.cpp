#include "prediction/repair_inputs.hpp"

#include <gtest/gtest.h>

#include "prediction/darkness.hpp"

namespace clearway::prediction {
namespace {

using testing::after_outage;

/// Inputs of a1, which was seen standing 40 s ago, and of e1, which stands 300 m ahead and reports.
class TwinInputs : public ::testing::Test {
  protected:
    TwinInputs()
        : observation_(after_outage(scene_, 40.0, {"a1"})),
          scenes_(scene_.network(), rules_, CandidateReach::twins),
          builder_(scene_.network(), rules_) {
        scenes_.build(observation_, found_);
        builder_.build(observation_, found_, inputs_);
    }
    float node(const char* id, std::size_t input) const {
        return inputs_.nodes[scene_.row(id) * node_width + input] * node_inputs[input].scale;
    }
    float edge(std::size_t input) const { return inputs_.edges[input] * edge_inputs[input].scale; }
    float pair(std::size_t input) const { return inputs_.pair_features[input] * pair_inputs[input].scale; }

    support::Scene scene_{R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        .a.............................e..............
    )"};
    graph::LinkRules rules_{.radius_m = 80.0};
    traffic::Observation observation_;
    SceneBuilder scenes_;
    Scene found_;
    RepairInputBuilder builder_;
    RepairInputs inputs_;
};

TEST_F(TwinInputs, AVehicleIsBelievedWhereItsTwinDroveTo) {
    ASSERT_EQ(inputs_.receivers.size(), 1U);
    EXPECT_NEAR(inputs_.receivers[0].displacement_m, 292.5F, 1.0F);
    EXPECT_EQ(node("a1", node_input("twin")), 1.0F);
    EXPECT_FLOAT_EQ(node("a1", node_input("twin_displacement")), inputs_.receivers[0].displacement_m);
    EXPECT_LT(node("a1", node_input("displacement")), 1.0F) << "the rule keeps what was seen standing";
    EXPECT_EQ(node("a1", node_input("twin_leader")), 1.0F);
    EXPECT_NEAR(node("a1", node_input("twin_leader_gap")), 2.5F, 1.0F);
    EXPECT_EQ(node("a1", node_input("twin_leader_age")), 0.0F);
    EXPECT_EQ(node("a1", node_input("twin_follower")), 0.0F);
    EXPECT_FLOAT_EQ(node("a1", node_input("twin_limit")), 20.0F);
    EXPECT_EQ(node("e1", node_input("twin")), 0.0F) << "it was heard";
}

TEST_F(TwinInputs, HearsTheLeaderOfItsTwin) {
    ASSERT_EQ(inputs_.source.size(), 1U);
    EXPECT_EQ(inputs_.source[0], scene_.row("e1"));
    EXPECT_EQ(edge(edge_input("twin_leads")), 1.0F);
    EXPECT_EQ(edge(edge_input("twin_follows")), 0.0F);
    EXPECT_EQ(edge(edge_input("on_way")), 1.0F);
    EXPECT_NEAR(edge(edge_input("way_lead")), 7.5F, 1.0F);
    EXPECT_NEAR(edge(edge_input("distance")), edge(edge_input("way_lead")), 0.1F);
}

TEST_F(TwinInputs, APairIsJudgedByItsTwins) {
    ASSERT_EQ(inputs_.pairs.size(), 1U);
    const float distance_m = pair(pair_input("by_twin"));
    EXPECT_NEAR(distance_m, 7.5F, 1.0F);
    EXPECT_NEAR(pair(pair_input("inside")), 80.0F - distance_m, 0.01F);
    EXPECT_FLOAT_EQ(pair(pair_input("radius")), 80.0F);
    EXPECT_GT(pair(pair_input("twin_logit")), 1.0F);
    EXPECT_EQ(pair(pair_input("twin_same_lane")), 1.0F);
    EXPECT_NEAR(pair(pair_input("ahead")), distance_m, 0.1F);
    EXPECT_NEAR(pair(pair_input("left")), 0.0F, 0.1F);
    EXPECT_NEAR(pair(pair_input("nearest")), 0.0F, 25.0F) << "a point of its way each 64 m";
    EXPECT_GT(pair(pair_input("share_within")), 0.0F);
    EXPECT_LT(pair(pair_input("share_within")), 0.5F);
}

}  // namespace
}  // namespace clearway::prediction
