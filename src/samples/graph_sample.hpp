#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "samples/detail/sample_file.hpp"
#include "samples/sample_origin.hpp"

namespace clearway::samples {

/// A pair of vehicles that may be linked, which a predictor has to decide.
struct CandidatePair {
    std::uint32_t left = 0;  ///< Row in the sample's features; left < right.
    std::uint32_t right = 0;
    float dead_reckoned_m = 0.0F;  ///< Distance of the dead-reckoned positions, m, >= 0.
    std::uint8_t linked = 0;       ///< 1: the true distance is below the link radius. The label.

    bool operator==(const CandidatePair&) const = default;
};

/// A link of the observed graph: both ends reported in the latest round, or one detected the other.
struct ObservedEdge {
    std::uint32_t left = 0;  ///< left < right; each undirected link is listed once.
    std::uint32_t right = 0;

    bool operator==(const ObservedEdge&) const = default;
};

/// One moment of one run: what a predictor was given, and the labels. Rows follow the observation's order.
struct GraphSample {
    double time_s = 0.0;
    std::uint32_t vehicle_count = 0;
    std::vector<float> features;  ///< Row-major, vehicle_count x width of the file's schema; finite.
    std::vector<ObservedEdge> observed_edges;
    std::vector<CandidatePair> candidates;

    bool operator==(const GraphSample&) const = default;
};

struct GraphSampleFile {
    SampleOrigin origin;
    std::vector<GraphSample> samples;
    std::string content_hash;  ///< 32 hex digits, over the whole file before its last line.
};

/// Name ending of sample files: `.samples`.
inline constexpr const char* graph_sample_extension = ".samples";

/// Holds the whole file in memory (about 15 bytes per candidate and 4 per feature). One thread.
///
/// Format, version 1: the line `clearway graph samples 1`, a line of JSON with the origin, little-endian
/// binary samples (time f64, counts of vehicles, edges and candidates u32, features f32, edges 2 u32,
/// candidates 2 u32 + f32 + u8), and `end <number of samples> <content hash>` as the last line.
class GraphSampleWriter : public detail::SampleFileWriter {
  public:
    explicit GraphSampleWriter(const SampleOrigin& origin);
    /// Throws std::logic_error when the sample does not fit the origin or its own counts, or holds a value
    /// that is not finite: a bug in the recorder.
    void add(const GraphSample& sample);

  private:
    std::uint32_t feature_count_;
};

/// Throws core::InputError for a file that is missing, of another version, cut short, changed since it was
/// written, or has an index, label or number out of range.
GraphSampleFile read_graph_samples(const std::filesystem::path& file);

/// The sample files in `folder` and the folders in it, sorted by name. Throws core::InputError when there is
/// none.
std::vector<std::filesystem::path> find_graph_samples(const std::filesystem::path& folder);

}  // namespace clearway::samples
