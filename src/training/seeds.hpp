#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "prediction/weights.hpp"
#include "samples/sample_origin.hpp"

namespace clearway::training {

// How data of many runs are split.

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

/// Where files of samples come from, in their order.
using Origins = std::vector<const samples::SampleOrigin*>;
template <class File>
Origins origins_of(const std::vector<File>& files) {
    Origins origins;
    for (const File& file : files)
        origins.push_back(&file.origin);
    return origins;
}
/// Splits the files by seed. Throws core::InputError without files, saying how to record some, and as
/// split_seeds does.
SeedSplit split_files(const Origins& origins, const SplitShares& shares, const std::string& recording);
/// Whether a file is of one of `seeds`, which are sorted.
bool is_of(const samples::SampleOrigin& origin, const std::vector<DataSeed>& seeds);
/// The least and greatest link radius.
prediction::RadiusRange link_radii(const Origins& origins);
/// Throws core::InputError naming the first file with other features or another link radius than the first.
void require_alike(const Origins& origins);
/// `--data: city, B10, replication 3`
std::string where_of(const samples::SampleOrigin& origin);

/// A new order each epoch, the same for the same training seed.
template <class Sample>
void shuffle(std::vector<const Sample*>& samples, std::uint64_t seed, std::uint32_t epoch) {
    const core::KeyedRandom random(core::StudySeed{seed}, core::Replication{epoch});
    for (std::size_t left = samples.size(); left > 1; --left)
        std::swap(samples[left - 1], samples[random.below(left, core::Purpose::training, left)]);
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

}  // namespace clearway::training
