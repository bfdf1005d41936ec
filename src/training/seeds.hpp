#pragma once

#include <cstdint>
#include <vector>

namespace clearway::training {

/// A seed of the data: all runs of it, of every scenario and failure, are in one part of the split.
struct DataSeed {
    std::uint64_t study_seed = 0;
    std::uint32_t replication = 0;
    auto operator<=>(const DataSeed&) const = default;
};

struct SeedSplit {
    std::vector<DataSeed> train, validation, test;  ///< Sorted; no seed in two of them.
};

/// How seeds are dealt.
struct SplitShares {
    std::uint64_t seed = 1;  ///< Of the draw.
    double validation = 0.2;
    double test = 0.2;
};

/// Deals the seeds by a keyed draw: at least one to each part. Throws core::InputError for fewer than three
/// seeds, and for shares that leave none to train on.
SeedSplit split_seeds(std::vector<DataSeed> seeds, const SplitShares& shares);

}  // namespace clearway::training
