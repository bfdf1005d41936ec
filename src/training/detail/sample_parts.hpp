#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "training/seeds.hpp"

namespace clearway::training::detail {

// Shared by the trainings on many snapshots. `File` is a file of samples, whose origin names its seed.

template <class File>
DataSeed seed_of(const File& file) {
    return {file.origin.study_seed, file.origin.replication};
}

/// Whether the file is of one of `seeds`, which are sorted.
template <class File>
bool is_of(const File& file, const std::vector<DataSeed>& seeds) {
    return std::ranges::binary_search(seeds, seed_of(file));
}

template <class File>
SeedSplit split_files(const std::vector<File>& files, const SplitShares& shares) {
    std::vector<DataSeed> seeds;
    std::ranges::transform(files, std::back_inserter(seeds), seed_of<File>);
    return split_seeds(std::move(seeds), shares);
}

/// A new order each epoch, the same for the same training seed.
template <class Sample>
void shuffle(std::vector<const Sample*>& samples, std::uint64_t seed, std::uint32_t epoch) {
    const core::KeyedRandom random(core::StudySeed{seed}, core::Replication{epoch});
    for (std::size_t left = samples.size(); left > 1; --left) {
        std::swap(samples[left - 1], samples[random.below(left, core::Purpose::training, left)]);
    }
}

/// How often each label occurs.
struct LabelCounts {
    std::size_t linked = 0;
    std::size_t unlinked = 0;

    void add(std::uint8_t label) { ++(label == 1 ? linked : unlinked); }
    void add(const std::vector<std::uint8_t>& labels) {
        for (const std::uint8_t label : labels)
            add(label);
    }
};

/// Throws core::InputError unless pairs of both kinds are in `part` ("training", "validation", "test") of the
/// split.
void require_both_classes(const LabelCounts& counts, const char* part);

}  // namespace clearway::training::detail
