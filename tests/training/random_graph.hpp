#pragma once

#include <random>

#include "training/comparison/graph_batch.hpp"

namespace clearway::training {

/// Vehicles, directed messages (some rows receive none, some a source twice) and pairs, all drawn; labels
/// drawn too.
inline GraphBatch random_graph(std::uint32_t seed, std::uint32_t vehicles, std::uint32_t width,
                               std::size_t pairs) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> feature(-3.0F, 3.0F);
    std::uniform_int_distribution<std::int64_t> row(0, vehicles - 1);
    GraphBatch batch;
    batch.feature_count = width;
    for (std::uint32_t value = 0; value < vehicles * width; ++value)
        batch.features.push_back(feature(random));
    for (std::size_t pair = 0; pair < pairs; ++pair) {
        batch.message_source.push_back(row(random));
        batch.message_target.push_back(row(random));
        batch.pair_left.push_back(row(random));
        batch.pair_right.push_back(row(random));
        batch.label.push_back(static_cast<float>(random() % 2));
    }
    return batch;
}

}  // namespace clearway::training
