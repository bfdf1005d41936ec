#pragma once

#include <cstdint>
#include <string>

#include "prediction/weights.hpp"

namespace clearway::samples {

/// What all samples of a file share: a file holds one run with one failure.
struct SampleOrigin {
    std::string scenario;
    std::string failure;                 ///< Name of the sensing preset, for example `B10`.
    prediction::FeatureSchema features;  ///< Meaning of the numbers; width in [1, 256].
    /// Forms the seed with `replication`. Training puts all runs of a seed in one part of the split.
    std::uint64_t study_seed = 1;
    std::uint32_t replication = 0;
    double link_radius_m = 50.0;
    /// How the traffic differs from the scenario's usual one: `under corridor, krauss`; empty if it does not.
    std::string traffic = {};

    bool operator==(const SampleOrigin&) const = default;
};

}  // namespace clearway::samples
