#include "prediction/boosted_trees.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <gmock/gmock.h>

#include "prediction/learned.hpp"
#include "prediction/tree_inputs.hpp"
#include "support/message_of.hpp"

namespace clearway::prediction {
namespace {

using support::message_of;
using ::testing::HasSubstr;

const FeatureSchema two_inputs{"two", 1, 2};

/// Two trees: one splits input 0 at 1, its right side input 1 at -2; the other is a leaf.
Weights two_trees() {
    Weights weights;
    weights.architecture = boosted_trees_architecture;
    weights.features = two_inputs;
    weights.source = "two.weights";
    weights.tensors = {{"base", {1}, {0.25F}},
                       {"root", {2}, {0, 5}},
                       {"input", {6}, {0, -1, 1, -1, -1, -1}},
                       {"threshold", {6}, {1, 10, -2, 20, 30, 100}},
                       {"left", {6}, {1, 0, 3, 0, 0, 0}}};
    return weights;
}

std::string refusal(const std::string& tensor, std::size_t at, float value) {
    Weights weights = two_trees();
    std::ranges::find(weights.tensors, tensor, &Tensor::name)->values[at] = value;
    return message_of([&] { BoostedTrees trees(weights, two_inputs); });
}

TEST(BoostedTrees, AddsTheLeavesThatARowReaches) {
    const BoostedTrees trees(two_trees(), two_inputs);
    EXPECT_EQ(trees.tree_count(), 2u);
    EXPECT_EQ(trees.node_count(), 6u);
    EXPECT_EQ(trees.sum(std::array{0.9F, 0.0F}), 110.25F) << "below";
    EXPECT_EQ(trees.sum(std::array{1.0F, -3.0F}), 120.25F) << "the threshold itself leads to the right";
    EXPECT_EQ(trees.sum(std::array{5.0F, -2.0F}), 130.25F);
}

TEST(BoostedTrees, RefusesWhatIsNoTree) {
    EXPECT_THAT(refusal("input", 0, 2.0F),
                HasSubstr("two.weights: input[0]: 2 (allowed: a whole number from -1 to 1)"));
    EXPECT_THAT(refusal("input", 2, 0.5F), HasSubstr("input[2]: 0.5"));
    EXPECT_THAT(refusal("left", 2, 1.0F), HasSubstr("a whole number from 3 to 4")) << "back to an ancestor";
    EXPECT_THAT(refusal("left", 0, 0.0F), HasSubstr("left[0]: 0")) << "itself";
    EXPECT_THAT(refusal("left", 2, 5.0F), HasSubstr("left[2]: 5")) << "its second child would be missing";
    EXPECT_THAT(refusal("root", 1, 6.0F), HasSubstr("root[1]: 6"));
}

TEST(BoostedTrees, RefusesOtherModels) {
    const auto message = [](const Weights& weights) {
        return message_of([&] { BoostedTrees trees(weights, two_inputs); });
    };
    Weights weights = two_trees();
    weights.features.version = 2;
    EXPECT_THAT(message(weights), HasSubstr("two"));
    weights = two_trees();
    weights.tensors.erase(weights.tensors.begin() + 2);
    EXPECT_THAT(message(weights), HasSubstr("tensors"));
    weights = two_trees();
    weights.tensors[3].values.pop_back();
    weights.tensors[3].shape = {5};
    EXPECT_THAT(message(weights), HasSubstr("threshold"));
    EXPECT_THAT(message_of([] { check_gradient_boosting(two_trees()); }), HasSubstr("tree_pairs"));
}

/// A scene of two vehicles not heard and one that was, on a straight road.
RepairInputs three_vehicles() {
    RepairInputs inputs;
    inputs.rows = 3;
    inputs.radius_m = 50.0F;
    inputs.nodes.assign(3 * node_width, 0.0F);
    inputs.x_m = {0.0F, 30.0F, 100.0F};
    inputs.y_m = {0.0F, 4.0F, 0.0F};
    inputs.place_sigma_m.assign(3, 0.0F);
    for (const std::uint32_t row : {0U, 1U}) {
        Receiver receiver;
        receiver.row = row;
        receiver.reach_m = 150.0F;
        receiver.displacement_m = row == 0 ? 50.0F : 0.0F;
        for (std::size_t i = 0; i < path_points; ++i)
            receiver.path.points[i] = {inputs.x_m[row] + 10.0F * static_cast<float>(i), inputs.y_m[row]};
        inputs.nodes[row * node_width + node_input("age")] = row == 0 ? 0.3F : 0.1F;
        inputs.receivers.push_back(receiver);
        inputs.source.push_back(2);
        inputs.edges.resize(inputs.source.size() * edge_width, 0.0F);
        float* const edge = &inputs.edges[row * edge_width];
        edge[edge_input("distance")] = 1.4F;
        edge[edge_input("known")] = 1.0F;
        edge[edge_input("detects")] = row == 0 ? 1.0F : 0.0F;
        inputs.first_edge.push_back(row + 1);
    }
    inputs.nodes[2 * node_width + node_input("known")] = 1.0F;
    inputs.pairs = {{0, 1}, {0, 2}, {1, 2}};
    inputs.pair_features.assign(3 * pair_width, 0.5F);
    return inputs;
}

std::vector<float> row_of(const RepairInputs& inputs, std::size_t at) {
    std::vector<float> row(tree_width, -1.0F);
    write_tree_inputs(inputs, at, row);
    return row;
}

float number(const RepairInputs& inputs, std::size_t at, const std::string& name) {
    const std::vector<std::string> names = tree_input_names().front().inputs;
    const auto place = std::ranges::find(names, name);
    EXPECT_NE(place, names.end()) << name;
    return row_of(inputs, at)[static_cast<std::size_t>(place - names.begin())];
}

TEST(TreeInputs, HaveANameEach) {
    const std::vector<std::string> names = tree_input_names().front().inputs;
    EXPECT_EQ(names.size(), tree_width);
    EXPECT_EQ(tree_schema().width, tree_width);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), tree_width);
}

TEST(TreeInputs, DoNotDependOnTheOrderOfAPair) {
    RepairInputs inputs = three_vehicles();
    const RepairInputs before = inputs;
    for (RowPair& pair : inputs.pairs)
        std::swap(pair.left, pair.right);
    for (std::size_t at = 0; at < inputs.pairs.size(); ++at)
        EXPECT_EQ(row_of(inputs, at), row_of(before, at)) << at;
}

TEST(TreeInputs, PutTheEndWithTheOlderReportFirst) {
    const RepairInputs inputs = three_vehicles();
    EXPECT_FLOAT_EQ(number(inputs, 0, "first_age"), 0.3F);
    EXPECT_FLOAT_EQ(number(inputs, 0, "second_age"), 0.1F);
    EXPECT_FLOAT_EQ(number(inputs, 1, "second_known"), 1.0F);
}

TEST(TreeInputs, GatherWhatEdgesTell) {
    const RepairInputs inputs = three_vehicles();
    EXPECT_FLOAT_EQ(number(inputs, 1, "first_sources"), 1.0F);
    EXPECT_FLOAT_EQ(number(inputs, 1, "first_known_sources"), 1.0F);
    EXPECT_FLOAT_EQ(number(inputs, 1, "first_nearest_known"), 1.4F);
    EXPECT_FLOAT_EQ(number(inputs, 1, "first_detectors"), 1.0F);
    EXPECT_FLOAT_EQ(number(inputs, 1, "first_farthest_detector"), 1.4F);
    EXPECT_FLOAT_EQ(number(inputs, 2, "first_detectors"), 0.0F);
    EXPECT_FLOAT_EQ(number(inputs, 1, "second_sources"), 0.0F) << "it was heard";
}

}  // namespace
}  // namespace clearway::prediction
