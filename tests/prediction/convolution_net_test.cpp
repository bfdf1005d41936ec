#include <cmath>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/nets.hpp"

namespace clearway::prediction {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using testing::values;

const FeatureSchema one_input{"test", 1, 1};

/// Three rows with x = 1, 2, 5; messages 0 -> 1 and 2 -> 1; every layer of width 1. The decoder passes
/// positive products on: logit = z_i z_j.
std::vector<float> logits_of(const Weights& weights, Convolution convolution,
                             const std::vector<std::uint32_t>& sources = {0, 2},
                             const std::vector<std::uint32_t>& targets = {1, 1}) {
    MessageGraph graph;
    message_graph_from(sources, targets, 3, graph);
    std::vector<float> logits;
    DissertationNet(convolution, weights, one_input)
        .logits(std::vector<float>{1, 2, 5}, graph, std::vector<RowPair>{{0, 1}, {1, 2}, {0, 2}}, logits);
    return logits;
}

Weights one_wide(Convolution convolution) {
    Weights weights = testing::zero_net(convolution, one_input, 1, 1);
    const std::string prefix = convolution == Convolution::gat ? "gat." : "gcn.";
    values(weights, prefix + "conv1.lin.weight") = {2};
    values(weights, prefix + "conv1.bias") = {1};
    values(weights, prefix + "conv2.lin.weight") = {1};
    values(weights, prefix + "conv2.bias") = {0.5F};
    values(weights, "nn.fc1.weight") = {1};
    values(weights, "nn.fc2.weight") = {1};
    return weights;
}

/// |N| = 1, 3, 1. W x = 2, 4, 10.
///     h0 = 2 + 1 = 3,  h1 = 2 / sqrt 3 + 4 / 3 + 10 / sqrt 3 + 1,  h2 = 10 + 1 = 11
///     z0 = 3.5,  z1 = 3 / sqrt 3 + h1 / 3 + 11 / sqrt 3 + 0.5,  z2 = 11.5
TEST(ConvolutionNet, GcnOfThreeRowsAsByHand) {
    const double root = std::sqrt(3.0);
    const double h1 = 12.0 / root + 4.0 / 3.0 + 1.0;
    const double z1 = 14.0 / root + h1 / 3.0 + 0.5;
    EXPECT_THAT(logits_of(one_wide(Convolution::gcn), Convolution::gcn),
                ElementsAre(FloatNear(static_cast<float>(3.5 * z1), 1e-4F),
                            FloatNear(static_cast<float>(11.5 * z1), 1e-4F), FloatNear(40.25F, 1e-4F)));
}

/// With s = 1 / 2, t = -1 in the first layer: scores of row 1 are leaky(1 - 4) = -0.6, leaky(5 - 4) = 1 and
/// its own leaky(2 - 4) = -0.4. In the second layer s = t = 0, so that it takes the mean.
TEST(ConvolutionNet, GatOfThreeRowsAsByHand) {
    Weights weights = one_wide(Convolution::gat);
    values(weights, "gat.conv1.att_src") = {0.5F};
    values(weights, "gat.conv1.att_dst") = {-1};
    const double from0 = std::exp(-0.6), from2 = std::exp(1.0), own = std::exp(-0.4);
    const double h1 = (2 * from0 + 10 * from2 + 4 * own) / (from0 + from2 + own) + 1;
    const double z1 = (3 + 11 + h1) / 3 + 0.5;
    EXPECT_THAT(logits_of(weights, Convolution::gat),
                ElementsAre(FloatNear(static_cast<float>(3.5 * z1), 1e-4F),
                            FloatNear(static_cast<float>(11.5 * z1), 1e-4F), FloatNear(40.25F, 1e-4F)));
}

TEST(ConvolutionNet, ARowHearsItselfOnce) {
    for (const Convolution convolution : {Convolution::gcn, Convolution::gat}) {
        Weights weights = one_wide(convolution);
        if (convolution == Convolution::gat) values(weights, "gat.conv1.att_src") = {0.5F};
        EXPECT_EQ(logits_of(weights, convolution, {0, 2, 1, 0}, {1, 1, 1, 0}),
                  logits_of(weights, convolution));
        EXPECT_NE(logits_of(weights, convolution, {0, 2, 0}, {1, 1, 1}), logits_of(weights, convolution));
    }
}

TEST(ConvolutionNet, AttentionKeepsLargeScoresFinite) {
    Weights weights = one_wide(Convolution::gat);
    values(weights, "gat.conv1.att_src") = {1000};
    for (const float logit : logits_of(weights, Convolution::gat))
        EXPECT_TRUE(std::isfinite(logit));
}

TEST(ConvolutionNet, RefusesAnotherNet) {
    EXPECT_THROW(DissertationNet(Convolution::gcn, one_wide(Convolution::gat), one_input), core::InputError);
    EXPECT_THROW(DissertationNet(Convolution::gat, testing::kernel_net(), corrected_schema()),
                 core::InputError);
    Weights more = one_wide(Convolution::gcn);
    more.tensors.push_back({"gcn.conv3.bias", {1}, {0.0F}});
    EXPECT_THROW(DissertationNet(Convolution::gcn, more, one_input), core::InputError);
}

}  // namespace
}  // namespace clearway::prediction
