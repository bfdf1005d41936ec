#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "prediction/repair_inputs.hpp"
#include "samples/detail/sample_file.hpp"
#include "samples/sample_origin.hpp"

namespace clearway::samples {

/// One moment of one run: what the improved net was given, and the labels.
struct RepairSample {
    double time_s = 0.0;
    prediction::RepairInputs inputs;
    std::vector<float> true_displacement_m;  ///< One per receiver, along its path; negative: no label.
    std::vector<std::uint8_t> linked;  ///< One per pair: 1 when the true distance is below the link radius.
    std::vector<float> rule;           ///< One per pair: probability by the route rule, for comparison.
};

struct RepairSampleFile {
    SampleOrigin origin;
    std::vector<RepairSample> samples;
    std::string content_hash;
};

/// The file has the frame of graph samples and the first line `clearway repair samples 2`. Receiver features
/// of vehicles that are not receivers are zero by construction and left out.
class RepairSampleWriter : public detail::SampleFileWriter {
  public:
    explicit RepairSampleWriter(const SampleOrigin& origin);
    /// Throws std::logic_error when its counts are inconsistent.
    void add(const RepairSample& sample);
};

/// Throws core::InputError for a file that is missing, of another version, cut short, changed since it was
/// written, made for another feature schema (naming both), or has an index, label or number out of range.
RepairSampleFile read_repair_samples(const std::filesystem::path& file);

}  // namespace clearway::samples
