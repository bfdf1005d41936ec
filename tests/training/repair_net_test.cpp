// prediction::RepairNet against libtorch.
#include "prediction/repair_net.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "synthetic_repair.hpp"
#include "training/repair.hpp"
#include "training/torch_repair_net.hpp"

namespace clearway::training {
namespace {

using prediction::BelievedMotion;
using prediction::Kernel;
using prediction::RepairNet;
using samples::RepairSample;

RepairNetConfig sizes(std::uint32_t hidden, std::uint32_t layers) {
    RepairNetConfig config;
    config.dimensions.hidden = hidden;
    config.dimensions.layers = layers;
    return config;
}

RepairBatch batch_of_one(const RepairSample& sample) {
    const RepairSample* const one = &sample;
    return batch_of(std::span(&one, 1), MessageEdges::believed);
}

TEST(RepairNet, agrees_with_libtorch) {
    for (const auto& config : {sizes(32, 2), sizes(20, 1), sizes(40, 3)}) {
        const TorchRepairNet torch(config);
        RepairNet own(repair_weights(torch.state(), config.dimensions));
        for (std::uint32_t seed = 0; seed < 5; ++seed) {
            const RepairSample sample = SyntheticRepair(seed).sample(0.0);
            const RepairOutput expected = torch.run(batch_of_one(sample));
            std::vector<float> logits;
            std::vector<BelievedMotion> motions;
            own.run(sample.inputs, logits, motions);
            ASSERT_EQ(logits.size(), expected.logits.size());
            for (std::size_t pair = 0; pair < logits.size(); ++pair) {
                EXPECT_NEAR(logits[pair], expected.logits[pair], 1e-5 * (1.0 + std::abs(logits[pair])));
            }
            ASSERT_EQ(motions.size(), expected.displacement_m.size());
            for (std::size_t i = 0; i < motions.size(); ++i) {
                const float held_m =
                    std::clamp(expected.displacement_m[i], 0.0F, sample.inputs.receivers[i].reach_m);
                EXPECT_NEAR(motions[i].displacement_m, held_m, 1e-3);
                EXPECT_NEAR(motions[i].sigma_m, expected.sigma_m[i], 1e-3);
            }
        }
    }
}

TEST(RepairNet, gives_the_same_bits_with_and_without_avx2) {
    if (prediction::best_kernel() != Kernel::avx2) GTEST_SKIP() << "this processor has no AVX2";
    const RepairNetConfig config = sizes(32, 2);
    const auto weights = repair_weights(TorchRepairNet(config).state(), config.dimensions);
    const RepairSample sample = SyntheticRepair(7).sample(0.0);
    std::vector<float> logits[2];
    std::vector<BelievedMotion> motions[2];
    RepairNet(weights, Kernel::scalar).run(sample.inputs, logits[0], motions[0]);
    RepairNet(weights, Kernel::avx2).run(sample.inputs, logits[1], motions[1]);
    EXPECT_EQ(logits[0], logits[1]);
    for (std::size_t i = 0; i < motions[0].size(); ++i) {
        EXPECT_EQ(motions[0][i].displacement_m, motions[1][i].displacement_m);
        EXPECT_EQ(motions[0][i].sigma_m, motions[1][i].sigma_m);
    }
}

TEST(RepairNet, does_not_care_which_end_of_a_pair_comes_first) {
    const RepairNetConfig config = sizes(32, 2);
    RepairNet net(repair_weights(TorchRepairNet(config).state(), config.dimensions));
    RepairSample sample = SyntheticRepair(9).sample(0.0);
    std::vector<float> logits, turned;
    std::vector<BelievedMotion> motions;
    net.run(sample.inputs, logits, motions);
    for (prediction::RowPair& pair : sample.inputs.pairs)
        std::swap(pair.left, pair.right);
    net.run(sample.inputs, turned, motions);
    EXPECT_EQ(logits, turned);
}

TEST(RepairNet, hears_its_neighbours) {
    const RepairNetConfig config = sizes(32, 2);
    RepairNet net(repair_weights(TorchRepairNet(config).state(), config.dimensions));
    RepairSample sample = SyntheticRepair(9).sample(0.0);
    std::vector<float> logits, changed;
    std::vector<BelievedMotion> motions;
    net.run(sample.inputs, logits, motions);
    sample.inputs.nodes[sample.inputs.source.front() * prediction::node_width + 4] += 1.0F;
    net.run(sample.inputs, changed, motions);
    EXPECT_NE(logits, changed);
}

TEST(RepairNet, takes_a_scene_without_receivers_and_pairs) {
    const RepairNetConfig config = sizes(32, 2);
    RepairNet net(repair_weights(TorchRepairNet(config).state(), config.dimensions));
    std::vector<float> logits = {1.0F};
    std::vector<BelievedMotion> motions = {{}};
    net.run({}, logits, motions);
    EXPECT_TRUE(logits.empty());
    EXPECT_TRUE(motions.empty());
}

TEST(RepairNet, refuses_other_features_and_sizes) {
    const RepairNetConfig config = sizes(32, 2);
    const prediction::Weights good = repair_weights(TorchRepairNet(config).state(), config.dimensions);
    const auto message_of = [](const prediction::Weights& weights) {
        try {
            RepairNet net(weights);
        } catch (const core::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message_of(good), "");
    prediction::Weights other = good;
    other.features.version = 99;
    EXPECT_THAT(message_of(other), ::testing::AllOf(::testing::HasSubstr("repair version 99"),
                                                    ::testing::HasSubstr("repair version 3")));
    other = good;
    for (prediction::Dimension& dimension : other.dimensions) {
        if (dimension.name == "edge") dimension.value = 3;
    }
    EXPECT_THAT(message_of(other), ::testing::HasSubstr("dimension edge is 3"));
    other = good;
    other.tensors.pop_back();
    EXPECT_THAT(message_of(other), ::testing::HasSubstr("skip"));
}

}  // namespace
}  // namespace clearway::training
