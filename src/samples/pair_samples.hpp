#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "prediction/comparison/pair_features.hpp"
#include "samples/sample_origin.hpp"

namespace clearway::samples {

/// Name ending of files of pair samples.
inline constexpr const char* pair_sample_ending = ".pairs.csv";

/// Candidate pairs with features (pair_features.hpp) and labels.
struct PairSampleFile {
    SampleOrigin origin;
    std::vector<prediction::PairFeatures> features;
    std::vector<std::uint8_t> linked;  ///< 1: the true distance is below the link radius. One per pair.
};

/// Writes the file atomically: a first line `# clearway pair samples 2` with the origin as JSON, a header
/// with the names of the features and `linked`, and a row per pair. Throws core::EnvironmentError.
void write_pair_samples(const std::filesystem::path& file, const PairSampleFile& samples);

/// Throws core::InputError with file and line of what is wrong (the first 20 places): another kind or version
/// of file, other features, ragged rows, a value that is not a finite number, a label other than 0 and 1.
PairSampleFile read_pair_samples(const std::filesystem::path& file);

/// The files of pair samples directly in `folder`, sorted by name. Throws core::InputError when there is
/// none.
std::vector<std::filesystem::path> find_pair_samples(const std::filesystem::path& folder);

}  // namespace clearway::samples
