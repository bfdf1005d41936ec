#pragma once

#include <cstdint>
#include <vector>

#include "samples/dataset_files.hpp"
#include "samples/graph_sample.hpp"

namespace clearway::training {

/// Vehicles, messages and pairs of one or several snapshots, as the net takes them. All indices are rows of
/// this batch: a snapshot that is appended has its indices moved behind the vehicles already there, so no
/// message and no pair joins two snapshots. (The published `custom_collate` concatenates the edge lists
/// without that offset: with more than one snapshot all edges would point into the first.)
struct GraphBatch {
    std::uint32_t feature_count = 0;
    std::vector<float> features;               ///< Row-major, one row per vehicle.
    std::vector<std::int64_t> message_source;  ///< A message flows from source to target.
    std::vector<std::int64_t> message_target;
    std::vector<std::int64_t> pair_left;
    std::vector<std::int64_t> pair_right;
    std::vector<float> label;  ///< 0 or 1, one per pair.

    std::size_t vehicle_count() const { return feature_count == 0 ? 0 : features.size() / feature_count; }
    std::size_t pair_count() const { return label.size(); }
};

/// Where the published training cuts the list of pairs: the first `int(n * (3 / 4)) + 1` train, the rest
/// tests.
struct OrderedSplit {
    std::size_t train = 0;  ///< Number of pairs, from the start of the list; at most n.
    std::size_t test = 0;
};
OrderedSplit ordered_split(std::size_t pair_count);

/// Pairs `first` to `first + count - 1` of the list over all vehicles, *as published*: the messages flow
/// along the very pairs that are to be predicted, from the first vehicle of a pair to the second.
GraphBatch as_published_batch(const samples::PairDataset& dataset, std::size_t first, std::size_t count);

/// *Corrected*: appends a snapshot. Messages flow both ways along observed edges and nowhere else; pairs are
/// the candidates nearer than `reach_m` by dead reckoning (the others are unlinked by definition). Asserts
/// that `width` is the batch's feature count.
void append_sample(const samples::GraphSample& sample, std::uint32_t width, double reach_m,
                   GraphBatch& batch);

}  // namespace clearway::training
