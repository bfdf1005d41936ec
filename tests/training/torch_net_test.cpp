#include "training/comparison/torch_net.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/state_dict.hpp"
#include "random_graph.hpp"

namespace clearway::training {
namespace {

using testing::ElementsAre;

/// The inference without torch on a batch.
std::vector<float> own_logits(const StateDict& state, const prediction::NetDimensions& dimensions,
                              const GraphBatch& batch) {
    const prediction::FeatureSchema schema{"test", 1, dimensions.input};
    prediction::DissertationNet net(
        Convolution::sage, prediction::net_weights(Convolution::sage, schema, dimensions, state), schema);
    const std::vector<std::uint32_t> sources(batch.message_source.begin(), batch.message_source.end());
    const std::vector<std::uint32_t> targets(batch.message_target.begin(), batch.message_target.end());
    prediction::MessageGraph graph;
    prediction::message_graph_from(sources, targets, batch.vehicle_count(), graph);
    std::vector<prediction::RowPair> pairs;
    for (std::size_t pair = 0; pair < batch.pair_count(); ++pair) {
        pairs.push_back({static_cast<std::uint32_t>(batch.pair_left[pair]),
                         static_cast<std::uint32_t>(batch.pair_right[pair])});
    }
    std::vector<float> logits;
    net.logits(batch.features, graph, pairs, logits);
    return logits;
}

/// The same for a net with another convolution.
std::vector<float> own_logits(const TorchNet& net, Convolution convolution,
                              const prediction::NetDimensions& dimensions, const GraphBatch& batch) {
    const prediction::FeatureSchema schema{"test", 1, dimensions.input};
    prediction::DissertationNet own(
        convolution, prediction::net_weights(convolution, schema, dimensions, net.state()), schema);
    prediction::MessageGraph graph;
    prediction::message_graph_from(
        std::vector<std::uint32_t>(batch.message_source.begin(), batch.message_source.end()),
        std::vector<std::uint32_t>(batch.message_target.begin(), batch.message_target.end()),
        batch.vehicle_count(), graph);
    std::vector<prediction::RowPair> pairs;
    for (std::size_t pair = 0; pair < batch.pair_count(); ++pair) {
        pairs.push_back({static_cast<std::uint32_t>(batch.pair_left[pair]),
                         static_cast<std::uint32_t>(batch.pair_right[pair])});
    }
    std::vector<float> logits;
    own.logits(batch.features, graph, pairs, logits);
    return logits;
}

/// Mean of log(1 + e^x) - y x, in double.
double cross_entropy(const std::vector<float>& logits, const std::vector<float>& labels) {
    double sum = 0.0;
    for (std::size_t pair = 0; pair < logits.size(); ++pair) {
        const double x = logits[pair];
        sum += std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))) - labels[pair] * x;
    }
    return sum / static_cast<double>(logits.size());
}

StateDict zeros(const prediction::NetDimensions& dimensions) {
    StateDict state = TorchNet({dimensions, 1, 0.01}).state();
    for (prediction::Tensor& tensor : state)
        std::ranges::fill(tensor.values, 0.0F);
    return state;
}

prediction::Tensor& named(StateDict& state, const std::string& name) {
    return *std::ranges::find(state, name, &prediction::Tensor::name);
}

/// Three vehicles in a row, 0 -> 1 and 2 -> 1; one feature; everything of width 1.
GraphBatch three_vehicles() {
    GraphBatch batch;
    batch.feature_count = 1;
    batch.features = {1.0F, 2.0F, 5.0F};
    batch.message_source = {0, 2};
    batch.message_target = {1, 1};
    batch.pair_left = {0, 1};
    batch.pair_right = {1, 2};
    batch.label = {1.0F, 0.0F};
    return batch;
}

TEST(TorchNet, three_vehicles_by_hand) {
    TorchNet net({{1, 1, 1}, 1, 0.01});
    StateDict state = zeros({1, 1, 1});
    named(state, "graphsage.conv1.lin_l.weight").values = {2.0F};
    named(state, "graphsage.conv1.lin_l.bias").values = {0.5F};
    named(state, "graphsage.conv1.lin_r.weight").values = {-1.0F};
    named(state, "graphsage.conv2.lin_l.weight").values = {1.0F};
    named(state, "graphsage.conv2.lin_l.bias").values = {-0.25F};
    named(state, "graphsage.conv2.lin_r.weight").values = {3.0F};
    named(state, "nn.fc1.weight").values = {0.5F};
    named(state, "nn.fc1.bias").values = {1.0F};
    named(state, "nn.fc2.weight").values = {2.0F};
    named(state, "nn.fc2.bias").values = {-1.0F};
    net.load(state);
    // First layer: h0 = 0.5 - 1 = -0.5; h1 = 2 * (1 + 5) / 2 + 0.5 - 2 = 4.5; h2 = 0.5 - 5 = -4.5.
    // Second: z0 = -0.25 - 1.5 = -1.75; z1 = (-0.5 - 4.5) / 2 - 0.25 + 13.5 = 10.75; z2 = -0.25 - 13.5 =
    // -13.75. Decoder: z0 z1 = -18.8125 -> relu(-8.40625) = 0 -> -1; z1 z2 is below zero likewise.
    EXPECT_THAT(net.logits(three_vehicles()), ElementsAre(-1.0F, -1.0F));
    named(state, "nn.fc1.weight").values = {-0.5F};
    net.load(state);
    // relu(9.40625 + 1) = 10.40625 -> 19.8125; z1 z2 = -147.8125 -> relu(73.90625 + 1) -> 148.8125.
    EXPECT_THAT(net.logits(three_vehicles()), ElementsAre(19.8125F, 148.8125F));
}

TEST(TorchNet, own_inference_agrees_within_1e_5) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const prediction::NetDimensions dimensions = seed % 3 == 0   ? prediction::NetDimensions{5, 10, 5}
                                                     : seed % 3 == 1 ? prediction::NetDimensions{2, 10, 5}
                                                                     : prediction::NetDimensions{7, 33, 17};
        const GraphBatch batch = random_graph(seed, 1 + seed * 7, dimensions.input, 40 * seed);
        const TorchNet net({dimensions, seed, 0.01});
        const std::vector<float> theirs = net.logits(batch);
        const std::vector<float> ours = own_logits(net.state(), dimensions, batch);
        ASSERT_EQ(ours.size(), theirs.size());
        for (std::size_t pair = 0; pair < ours.size(); ++pair) {
            ASSERT_NEAR(ours[pair], theirs[pair], 1e-5) << "graph " << seed << ", pair " << pair;
        }
    }
}

TEST(TorchNet, own_inference_of_gcn_and_gat_agrees_within_1e_5_before_and_after_training) {
    for (const Convolution convolution : {Convolution::gcn, Convolution::gat}) {
        for (std::uint32_t seed = 1; seed <= 12; ++seed) {
            const prediction::NetDimensions dimensions =
                seed % 2 == 0 ? prediction::NetDimensions{5, 10, 5} : prediction::NetDimensions{7, 33, 17};
            const GraphBatch batch = random_graph(seed, 1 + seed * 7, dimensions.input, 40 * seed);
            TorchNet net({dimensions, seed, 0.01, convolution});
            EXPECT_THAT(own_logits(net, convolution, dimensions, batch),
                        testing::Pointwise(testing::FloatNear(1e-5F), net.logits(batch)))
                << name(convolution) << ", graph " << seed;
            const double before = net.loss(batch);
            for (int step = 0; step < 20; ++step)
                net.train_step(batch);
            EXPECT_LT(net.loss(batch), before) << name(convolution) << ", graph " << seed;
            EXPECT_THAT(own_logits(net, convolution, dimensions, batch),
                        testing::Pointwise(testing::FloatNear(1e-5F), net.logits(batch)))
                << name(convolution) << ", trained graph " << seed;
        }
    }
}

TEST(TorchNet, own_inference_agrees_after_training) {
    const GraphBatch batch = random_graph(3, 30, 5, 200);
    TorchNet net({{5, 10, 5}, 3, 0.01});
    for (int step = 0; step < 50; ++step)
        net.train_step(batch);
    EXPECT_THAT(own_logits(net.state(), {5, 10, 5}, batch),
                testing::Pointwise(testing::FloatNear(1e-5F), net.logits(batch)));
}

TEST(TorchNet, loss_is_the_mean_cross_entropy) {
    const GraphBatch batch = random_graph(4, 20, 2, 100);
    const TorchNet net({{2, 10, 5}, 4, 0.01});
    EXPECT_NEAR(net.loss(batch), cross_entropy(net.logits(batch), batch.label), 1e-6);
}

TEST(TorchNet, a_constant_net_has_the_loss_of_its_constant) {
    TorchNet net({{1, 1, 1}, 1, 0.01});
    StateDict state = zeros({1, 1, 1});
    named(state, "nn.fc2.bias").values = {3.0F};
    net.load(state);
    GraphBatch batch = three_vehicles();
    batch.label = {1.0F, 1.0F};
    EXPECT_NEAR(net.loss(batch), std::log1p(std::exp(-3.0)), 1e-7);
    batch.label = {1.0F, 0.0F};
    EXPECT_NEAR(net.loss(batch), (std::log1p(std::exp(-3.0)) + std::log1p(std::exp(3.0))) / 2, 1e-6);
}

TEST(TorchNet, the_first_step_of_adam_moves_each_parameter_against_its_gradient) {
    // Adam's first step is the learning rate times the gradient's sign; the gradient here is a difference
    // quotient of the inference without torch.
    const prediction::NetDimensions dimensions{2, 10, 5};
    const GraphBatch batch = random_graph(9, 12, 2, 60);
    TorchNet net({dimensions, 9, 0.01});
    StateDict state = net.state();
    EXPECT_NEAR(net.train_step(batch), cross_entropy(own_logits(state, dimensions, batch), batch.label),
                1e-6);
    const StateDict moved = net.state();
    int checked = 0;
    for (std::size_t at = 0; at < state.size(); ++at) {
        for (std::size_t element = 0; element < state[at].values.size(); ++element) {
            float& value = state[at].values[element];
            const float kept = value;
            value = kept + 0.01F;
            const double above = cross_entropy(own_logits(state, dimensions, batch), batch.label);
            value = kept - 0.01F;
            const double below = cross_entropy(own_logits(state, dimensions, batch), batch.label);
            value = kept;
            const double slope = (above - below) / 0.02;
            if (std::abs(slope) < 0.0005) continue;  // Too flat for the quotient's sign.
            EXPECT_NEAR(moved[at].values[element] - kept, slope > 0 ? -0.01 : 0.01, 1e-5)
                << state[at].name << " " << element;
            ++checked;
        }
    }
    EXPECT_GT(checked, 20);
}

TEST(TorchNet, training_lowers_the_loss) {
    const GraphBatch batch = random_graph(5, 30, 2, 40);
    TorchNet net({{2, 10, 5}, 5, 0.01});
    const double before = net.loss(batch);
    for (int step = 0; step < 100; ++step)
        net.train_step(batch);
    EXPECT_LT(net.loss(batch), before - 0.05);
}

TEST(TorchNet, parameters_start_uniform_within_one_over_the_root_of_the_inputs) {
    const StateDict state = TorchNet({{5, 400, 50}, 2, 0.01}).state();
    const auto check = [&](const std::string& name, double inputs) {
        const auto& values = std::ranges::find(state, name, &prediction::Tensor::name)->values;
        const auto [low, high] = std::ranges::minmax_element(values);
        const double bound = 1.0 / std::sqrt(inputs);
        EXPECT_GE(*low, -bound) << name;
        EXPECT_LE(*high, bound) << name;
        EXPECT_LT(*low, -0.85 * bound) << name;
        EXPECT_GT(*high, 0.85 * bound) << name;
    };
    check("graphsage.conv1.lin_l.weight", 5);
    check("graphsage.conv1.lin_l.bias", 5);
    check("graphsage.conv1.lin_r.weight", 5);
    check("graphsage.conv2.lin_l.weight", 400);
    check("graphsage.conv2.lin_l.bias", 400);
    check("graphsage.conv2.lin_r.weight", 400);
    check("nn.fc1.weight", 50);
    check("nn.fc1.bias", 50);
    check("nn.fc2.weight", 400);
}

TEST(TorchNet, the_seed_decides_the_parameters) {
    const TorchNetConfig config{{2, 10, 5}, 11, 0.01};
    TorchNetConfig other = config;
    other.seed = 12;
    const std::string first = prediction::format_pth(TorchNet(config).state(), "net");
    EXPECT_EQ(prediction::format_pth(TorchNet(config).state(), "net"), first);
    EXPECT_NE(prediction::format_pth(TorchNet(other).state(), "net"), first);
}

TEST(TorchNet, rows_without_messages_and_graphs_without_links_work) {
    GraphBatch batch = random_graph(6, 4, 2, 5);
    batch.message_source.clear();
    batch.message_target.clear();
    const TorchNet net({{2, 10, 5}, 6, 0.01});
    EXPECT_THAT(own_logits(net.state(), {2, 10, 5}, batch),
                testing::Pointwise(testing::FloatNear(1e-5F), net.logits(batch)));
}

TEST(TorchNet, a_loss_that_is_not_finite_leaves_the_parameters) {
    GraphBatch batch = random_graph(7, 10, 2, 20);
    std::ranges::fill(batch.features, 3e38F);
    TorchNet net({{2, 10, 5}, 7, 0.01});
    const std::string before = prediction::format_pth(net.state(), "net");
    EXPECT_FALSE(std::isfinite(net.train_step(batch)));
    EXPECT_EQ(prediction::format_pth(net.state(), "net"), before);
}

TEST(TorchNet, a_state_of_another_net_is_refused) {
    TorchNet net({{2, 10, 5}, 1, 0.01});
    EXPECT_THROW(net.load(TorchNet({{5, 10, 5}, 1, 0.01}).state()), std::logic_error);
    EXPECT_THROW(net.load({}), std::logic_error);
}

}  // namespace
}  // namespace clearway::training
