#include "prediction/boosted_trees.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::prediction {
namespace {

constexpr const char* cure = "Train the model again";

/// The only tensor of this name, with one axis.
const Tensor& list(const Weights& weights, const char* name) {
    const auto found = std::ranges::find(weights.tensors, name, &Tensor::name);
    if (found == weights.tensors.end())
        throw core::InputError({weights.source, fmt::format("no tensor {}", name),
                                "tensors base, root, input, threshold, left", cure});
    if (found->shape.size() != 1)
        throw core::InputError(
            {weights.source, fmt::format("{} has {} axes", name, found->shape.size()), "1", cure});
    return *found;
}

/// The number at a place of a list, which is a whole one from `least` to `most`.
std::int64_t whole_number(const Weights& weights, const Tensor& tensor, std::size_t at, std::int64_t least,
                          std::int64_t most) {
    const double value = tensor.values[at];
    const bool fits = value == std::floor(value) && value >= static_cast<double>(least) &&
                      value <= static_cast<double>(most);
    if (!fits)
        throw core::InputError({fmt::format("{}: {}[{}]", weights.source, tensor.name, at),
                                fmt::format("{}", tensor.values[at]),
                                fmt::format("a whole number from {} to {}", least, most), cure});
    return static_cast<std::int64_t>(value);
}

}  // namespace

BoostedTrees::BoostedTrees(const Weights& weights, const FeatureSchema& features) {
    weights.require(boosted_trees_architecture, features);
    weights.require_tensors(5);
    base_ = weights.tensor("base", {1}).values[0];
    const Tensor& input = list(weights, "input");
    const std::vector<std::uint32_t> shape = {static_cast<std::uint32_t>(input.values.size())};
    const Tensor& threshold = weights.tensor("threshold", shape);
    const Tensor& left = weights.tensor("left", shape);
    const auto count = static_cast<std::int64_t>(input.values.size());
    nodes_.resize(input.values.size());
    for (std::size_t at = 0; at < nodes_.size(); ++at) {
        Node& node = nodes_[at];
        node.threshold = threshold.values[at];
        node.input = static_cast<std::int32_t>(
            whole_number(weights, input, at, -1, static_cast<std::int64_t>(features.width) - 1));
        if (node.input < 0) continue;
        // Children come after their parent, so every walk ends.
        node.left = static_cast<std::uint32_t>(
            whole_number(weights, left, at, static_cast<std::int64_t>(at) + 1, count - 2));
    }
    const Tensor& root = list(weights, "root");
    for (std::size_t at = 0; at < root.values.size(); ++at)
        roots_.push_back(static_cast<std::uint32_t>(whole_number(weights, root, at, 0, count - 1)));
}

float BoostedTrees::sum(std::span<const float> row) const {
    float sum = base_;
    for (const std::uint32_t root : roots_) {
        const Node* node = &nodes_[root];
        while (node->input >= 0) {
            const bool below = row[static_cast<std::size_t>(node->input)] < node->threshold;
            node = &nodes_[node->left + (below ? 0U : 1U)];
        }
        sum += node->threshold;
    }
    return sum;
}

}  // namespace clearway::prediction
