#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction {

inline constexpr const char* boosted_trees_architecture = "boosted_trees";

/// A sum of regression trees (Friedman 2001, "Greedy function approximation: a gradient boosting machine").
/// As a file of weights: tensors `base` {1}, `root` {trees} and, of all nodes, `input`, `threshold` and
/// `left`. A node leads to `left` where its input is below the threshold, else to `left` + 1; children follow
/// their parent. A leaf has input -1 and its value as the threshold.
class BoostedTrees {
  public:
    /// Throws core::InputError when the weights are no such trees for these features.
    BoostedTrees(const Weights& weights, const FeatureSchema& features);

    /// The sum over all trees, a logit. `row` has one number per input of the features.
    float sum(std::span<const float> row) const;
    std::size_t tree_count() const { return roots_.size(); }
    std::size_t node_count() const { return nodes_.size(); }

  private:
    struct Node {
        float threshold = 0.0F;
        std::int32_t input = -1;
        std::uint32_t left = 0;
    };
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> roots_;
    float base_ = 0.0F;
};

}  // namespace clearway::prediction
