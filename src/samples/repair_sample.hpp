#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "prediction/repair_inputs.hpp"
#include "samples/sample_origin.hpp"

namespace clearway::samples {

/// One moment of one run: what the improved net was given, and the answers.
struct RepairSample {
    double time_s = 0.0;
    prediction::RepairInputs inputs;
    std::vector<float> true_displacement_m;  ///< One a receiver, along its path; negative without a label.
    std::vector<std::uint8_t> linked;  ///< One a pair: 1 when the true distance is below the link radius.
    std::vector<float> rule;           ///< One a pair: probability by the route rule, to compare with.
};

struct RepairSampleFile {
    SampleOrigin origin;
    std::vector<RepairSample> samples;
    std::string content_hash;
};

/// Collects the samples of one run of one failure, as GraphSampleWriter does, and writes them as one file of
/// the same frame with the first line `clearway repair samples 1`. Numbers that are zero by construction are
/// left out: features of receivers, of vehicles that are none.
class RepairSampleWriter {
  public:
    explicit RepairSampleWriter(const SampleOrigin& origin);
    /// Throws std::logic_error when counts do not fit each other.
    void add(const RepairSample& sample);
    std::size_t sample_count() const { return sample_count_; }
    /// Writes the file whole or not at all. Throws core::EnvironmentError.
    void write(const std::filesystem::path& file) const;

  private:
    std::string bytes_;
    std::size_t sample_count_ = 0;
};

/// Throws core::InputError: missing, of another version, cut short, changed since it was written, made for
/// another feature schema (naming both), or with an index, label or number out of range.
RepairSampleFile read_repair_samples(const std::filesystem::path& file);

}  // namespace clearway::samples
