#include "prediction/comparison/dissertation_net.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "prediction/nets.hpp"

namespace clearway::prediction {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using testing::random_net;
using testing::values;
using testing::zero_net;

constexpr Kernel kernels[] = {Kernel::scalar, Kernel::avx2};

bool available(Kernel kernel) {
    return kernel == Kernel::scalar || best_kernel() == Kernel::avx2;
}

MessageGraph messages(const std::vector<std::uint32_t>& sources, const std::vector<std::uint32_t>& targets,
                      std::size_t rows) {
    MessageGraph graph;
    message_graph_from(sources, targets, rows, graph);
    return graph;
}

TEST(MessageGraph, ListsSourcesByReceiverInTheirOrder) {
    const MessageGraph graph = messages({2, 0, 2, 1, 2}, {1, 1, 0, 3, 1}, 4);
    EXPECT_THAT(graph.first, ElementsAre(0, 1, 4, 4, 5));
    EXPECT_THAT(graph.source, ElementsAre(2, 2, 0, 2, 1));
}

/// Three vehicles; messages 0 -> 1, 2 -> 1, 1 -> 2. By hand:
///
///     x      = (1, 2), (3, -1), (0, 4)
///     mean   = (0, 0), (0.5, 3), (3, -1)
///     h      = mean_0 + 2 mean_1 + 1 + x_0 - x_1,  mean_0 + x_1
///            = (0, 2), (11.5, -0.5), (-2, 7)
///     mean h = (0, 0), (-1, 4.5), (11.5, -0.5)
///     z      = 2 mean h_0 + h_1, mean h_1 + h_0 + 0.5
///            = (2, 0.5), (-2.5, 16.5), (30, -2)
Weights three_node_net() {
    Weights net = zero_net(as_published_position_schema(), 2, 2);
    values(net, "graphsage.conv1.lin_l.weight") = {1, 2, 1, 0};
    values(net, "graphsage.conv1.lin_l.bias") = {1, 0};
    values(net, "graphsage.conv1.lin_r.weight") = {1, -1, 0, 1};
    values(net, "graphsage.conv2.lin_l.weight") = {2, 0, 0, 1};
    values(net, "graphsage.conv2.lin_l.bias") = {0, 0.5F};
    values(net, "graphsage.conv2.lin_r.weight") = {0, 1, 1, 0};
    values(net, "nn.fc1.weight") = {1, 1, -1, 0.5F};
    values(net, "nn.fc1.bias") = {10, 3};
    values(net, "nn.fc2.weight") = {2, -1};
    values(net, "nn.fc2.bias") = {0.25F};
    return net;
}

TEST(DissertationNet, ComputesThreeVehiclesAsByHand) {
    const std::vector<float> features = {1, 2, 3, -1, 0, 4};
    const MessageGraph graph = messages({0, 2, 1}, {1, 1, 2}, 3);
    // z0 * z1 = (-5, 8.25): fc1 = (13.25, 12.125), both pass: 2 x 13.25 - 12.125 + 0.25 = 14.625
    // z1 * z2 = (-75, -33): fc1 = (-98, 61.5), the first is cut: -61.5 + 0.25 = -61.25
    // z0 * z2 = (60, -1):   fc1 = (69, -57.5), the second is cut: 138 + 0.25 = 138.25
    for (const Kernel kernel : kernels) {
        if (!available(kernel)) continue;
        DissertationNet net(Convolution::sage, three_node_net(), as_published_position_schema(), kernel);
        std::vector<float> logits;
        net.logits(features, graph, std::vector<RowPair>{{0, 1}, {1, 2}, {2, 0}}, logits);
        EXPECT_THAT(logits, ElementsAre(FloatEq(14.625F), FloatEq(-61.25F), FloatEq(138.25F)));
        const auto embeddings = net.embeddings();
        const std::size_t stride = net.embedding_stride();
        EXPECT_THAT(embeddings.subspan(0, 2), ElementsAre(2.0F, 0.5F));
        EXPECT_THAT(embeddings.subspan(stride, 2), ElementsAre(-2.5F, 16.5F));
        EXPECT_THAT(embeddings.subspan(2 * stride, 2), ElementsAre(30.0F, -2.0F));
    }
}

TEST(DissertationNet, SendsMessagesFromSourceToTargetOnly) {
    DissertationNet net(Convolution::sage, three_node_net(), as_published_position_schema());
    const std::vector<float> features = {1, 2, 3, -1, 0, 4};
    std::vector<float> forwards;
    std::vector<float> backwards;
    net.logits(features, messages({0}, {1}, 3), std::vector<RowPair>{{0, 1}}, forwards);
    net.logits(features, messages({1}, {0}, 3), std::vector<RowPair>{{0, 1}}, backwards);
    EXPECT_NE(forwards, backwards);
}

TEST(DissertationNet, CountsASourceThatStandsTwiceTwice) {
    DissertationNet net(Convolution::sage, three_node_net(), as_published_position_schema());
    const std::vector<float> features = {1, 2, 3, -1, 0, 4};
    std::vector<float> once;
    std::vector<float> twice;
    net.logits(features, messages({0, 2}, {1, 1}, 3), std::vector<RowPair>{{0, 1}}, once);
    net.logits(features, messages({0, 0, 2}, {1, 1, 1}, 3), std::vector<RowPair>{{0, 1}}, twice);
    EXPECT_NE(once, twice);
}

/// A slow reference in double precision, straight from the equations.
double reference_logit(Weights net, const std::vector<float>& features, const std::vector<RowPair>& edges,
                       RowPair pair) {
    const std::size_t rows = features.size() / net.features.width;
    std::vector<std::vector<double>> state(rows);
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t at = 0; at < net.features.width; ++at) {
            state[row].push_back(features[row * net.features.width + at]);
        }
    }
    for (const std::string layer : {"graphsage.conv1", "graphsage.conv2"}) {
        const auto& left = values(net, layer + ".lin_l.weight");
        const auto& right = values(net, layer + ".lin_r.weight");
        const auto& bias = values(net, layer + ".lin_l.bias");
        std::vector<std::vector<double>> next(rows);
        for (std::size_t row = 0; row < rows; ++row) {
            const std::size_t width = state[row].size();
            std::vector<double> mean(width, 0.0);
            double count = 0.0;
            for (const RowPair edge : edges) {
                if (edge.right != row) continue;
                ++count;
                for (std::size_t at = 0; at < width; ++at) {
                    mean[at] += state[edge.left][at];
                }
            }
            for (std::size_t out = 0; out < bias.size(); ++out) {
                double sum = bias[out];
                for (std::size_t at = 0; at < width; ++at) {
                    sum += left[out * width + at] * mean[at] / std::max(count, 1.0) +
                           right[out * width + at] * state[row][at];
                }
                next[row].push_back(sum);
            }
        }
        state = next;
    }
    const std::size_t width = state[0].size();
    double logit = values(net, "nn.fc2.bias")[0];
    for (std::size_t hidden = 0; hidden < values(net, "nn.fc1.bias").size(); ++hidden) {
        double sum = values(net, "nn.fc1.bias")[hidden];
        for (std::size_t at = 0; at < width; ++at) {
            sum += values(net, "nn.fc1.weight")[hidden * width + at] * state[pair.left][at] *
                   state[pair.right][at];
        }
        logit += values(net, "nn.fc2.weight")[hidden] * std::max(sum, 0.0);
    }
    return logit;
}

struct Case {
    std::vector<float> features;
    std::vector<RowPair> edges;
    std::vector<RowPair> pairs;
    MessageGraph graph;
};

Case random_case(std::uint32_t rows, std::uint32_t width) {
    const core::KeyedRandom random({3}, {0});
    Case result;
    for (std::uint64_t at = 0; at < rows * width; ++at) {
        result.features.push_back(static_cast<float>(random.normal(core::Purpose::training, 1, at)));
    }
    std::vector<std::uint32_t> sources;
    std::vector<std::uint32_t> targets;
    for (std::uint64_t at = 0; at < 3 * rows; ++at) {
        const auto pick = [&](std::uint64_t subject) {
            return static_cast<std::uint32_t>(random.below(rows, core::Purpose::training, subject, at));
        };
        sources.push_back(pick(2));
        targets.push_back(pick(3));
        result.edges.push_back({sources.back(), targets.back()});
        result.pairs.push_back({pick(4), pick(5)});
    }
    message_graph_from(sources, targets, rows, result.graph);
    return result;
}

TEST(DissertationNet, AgreesWithASlowReferenceForOtherSizes) {
    struct Sizes {
        std::uint32_t width, hidden, output;
    };
    for (const Sizes sizes :
         {Sizes{2, 10, 5}, Sizes{5, 10, 5}, Sizes{12, 32, 16}, Sizes{8, 8, 8}, Sizes{1, 1, 1}}) {
        const FeatureSchema schema{"test", 1, sizes.width};
        const Weights weights = random_net(schema, sizes.hidden, sizes.output, 0.3);
        const Case input = random_case(40, sizes.width);
        DissertationNet net(Convolution::sage, weights, schema);
        std::vector<float> logits;
        net.logits(input.features, input.graph, input.pairs, logits);
        for (std::size_t at = 0; at < input.pairs.size(); ++at) {
            const double expected = reference_logit(weights, input.features, input.edges, input.pairs[at]);
            EXPECT_NEAR(logits[at], expected, 1e-5 * std::max(1.0, std::abs(expected)));
        }
    }
}

TEST(DissertationNet, GivesTheSameBitsWithAndWithoutAvx2) {
    if (!available(Kernel::avx2)) GTEST_SKIP() << "this processor has no AVX2";
    const FeatureSchema schema{"test", 1, 12};
    const Weights weights = random_net(schema, 32, 16);
    const Case input = random_case(300, 12);
    DissertationNet fast(Convolution::sage, weights, schema, Kernel::avx2);
    DissertationNet plain(Convolution::sage, weights, schema, Kernel::scalar);
    std::vector<float> from_fast;
    std::vector<float> from_plain;
    fast.logits(input.features, input.graph, input.pairs, from_fast);
    plain.logits(input.features, input.graph, input.pairs, from_plain);
    EXPECT_EQ(from_fast, from_plain);
}

TEST(DissertationNet, TakesNoVehiclesAndNoPairs) {
    DissertationNet net(Convolution::sage, three_node_net(), as_published_position_schema());
    std::vector<float> logits = {1.0F};
    net.logits({}, MessageGraph{}, {}, logits);
    EXPECT_TRUE(logits.empty());
}

TEST(DissertationNet, RefusesOtherFeaturesAndShapes) {
    const Weights weights = three_node_net();
    try {
        DissertationNet(Convolution::sage, weights, {"as_published_position", 2, 2});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("version 1"), HasSubstr("version 2")));
    }
    Weights wider = weights;
    wider.dimensions[1].value = 3;
    EXPECT_THROW(DissertationNet(Convolution::sage, wider, as_published_position_schema()), core::InputError);
    Weights incomplete = weights;
    incomplete.tensors.pop_back();
    EXPECT_THROW(DissertationNet(Convolution::sage, incomplete, as_published_position_schema()),
                 core::InputError);
}

TEST(Logistic, MapsLogitsToProbabilities) {
    EXPECT_FLOAT_EQ(probability_from_logit(0.0F), 0.5F);
    EXPECT_FLOAT_EQ(probability_from_logit(std::log(3.0F)), 0.75F);
    EXPECT_EQ(probability_from_logit(-1000.0F), 0.0F);
    EXPECT_EQ(probability_from_logit(1000.0F), 1.0F);
}

}  // namespace
}  // namespace clearway::prediction
