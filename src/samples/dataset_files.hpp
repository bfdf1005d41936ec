#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace clearway::samples {

/// One snapshot as chapter 5.4 of the dissertation stores it: vehicles with features, and a list of pairs
/// with labels. The order of the pairs matters: the published training splits by it.
struct PairDataset {
    std::uint32_t feature_count = 0;    ///< 2 or 5.
    std::vector<float> features;        ///< Row-major, one row per vehicle; finite.
    std::vector<std::uint32_t> source;  ///< Row of the pair's first vehicle.
    std::vector<std::uint32_t> target;
    std::vector<float> label;  ///< 0 or 1, one per pair.

    std::size_t vehicle_count() const { return feature_count == 0 ? 0 : features.size() / feature_count; }
    std::size_t pair_count() const { return label.size(); }
    bool operator==(const PairDataset&) const = default;
};

/// Names of the three files.
inline constexpr const char* edge_list_file = "edge_list.csv";
inline constexpr const char* vehicle_features_file = "vehicle_features.csv";
inline constexpr const char* target_file = "target_y.csv";

/// Reads `edge_list.csv` (two rows of integers), `vehicle_features.csv` (a row of 2 or 5 numbers per vehicle)
/// and `target_y.csv` (one row of 0 and 1), without headers. Throws core::InputError with file, line and
/// column of everything wrong (the first 20 places): missing file, ragged rows, text, numbers that are not
/// finite, an index out of range, a vehicle paired with itself, labels other than 0 and 1, lengths that
/// differ, no data.
PairDataset read_pair_dataset(const std::filesystem::path& folder);

/// Writes the three files into `folder` (created if absent), each atomically. Numbers are the shortest text
/// that reads back as the same float. Throws core::EnvironmentError, and std::logic_error for a data set that
/// `read_pair_dataset` would refuse for its sizes.
void write_pair_dataset(const std::filesystem::path& folder, const PairDataset& dataset);

}  // namespace clearway::samples
