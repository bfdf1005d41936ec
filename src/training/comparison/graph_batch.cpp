#include "training/comparison/graph_batch.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::training {

OrderedSplit ordered_split(std::size_t pair_count) {
    const std::size_t train = std::min(pair_count * 3 / 4 + 1, pair_count);
    return {train, pair_count - train};
}

GraphBatch as_published_batch(const samples::PairDataset& dataset, std::size_t first, std::size_t count) {
    assert(first + count <= dataset.pair_count());
    GraphBatch batch;
    batch.feature_count = dataset.feature_count;
    batch.features = dataset.features;
    batch.pair_left.assign(dataset.source.begin() + static_cast<std::ptrdiff_t>(first),
                           dataset.source.begin() + static_cast<std::ptrdiff_t>(first + count));
    batch.pair_right.assign(dataset.target.begin() + static_cast<std::ptrdiff_t>(first),
                            dataset.target.begin() + static_cast<std::ptrdiff_t>(first + count));
    batch.label.assign(dataset.label.begin() + static_cast<std::ptrdiff_t>(first),
                       dataset.label.begin() + static_cast<std::ptrdiff_t>(first + count));
    batch.message_source = batch.pair_left;
    batch.message_target = batch.pair_right;
    return batch;
}

void append_sample(const samples::GraphSample& sample, std::uint32_t width, double reach_m,
                   GraphBatch& batch) {
    assert(batch.feature_count == 0 || batch.feature_count == width);
    batch.feature_count = width;
    const auto offset = static_cast<std::int64_t>(batch.vehicle_count());
    batch.features.insert(batch.features.end(), sample.features.begin(), sample.features.end());
    for (const samples::ObservedEdge& edge : sample.observed_edges) {
        const std::int64_t left = offset + edge.left;
        const std::int64_t right = offset + edge.right;
        batch.message_source.insert(batch.message_source.end(), {left, right});
        batch.message_target.insert(batch.message_target.end(), {right, left});
    }
    for (const samples::CandidatePair& pair : sample.candidates) {
        if (pair.dead_reckoned_m >= reach_m) continue;
        batch.pair_left.push_back(offset + pair.left);
        batch.pair_right.push_back(offset + pair.right);
        batch.label.push_back(pair.linked);
    }
}

}  // namespace clearway::training
