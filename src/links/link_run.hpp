#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "links/link_scores.hpp"
#include "sensing/failure_config.hpp"

namespace clearway::links {

using sensing::Exits;

/// What one predictor did in one run under one failure.
struct LinkCase {
    std::string failure;
    Exits exits = Exits::known;
    LinkTruth truth;
    LinkBelief belief;
    LinkScoreSummary scores;

    bool operator==(const LinkCase&) const = default;
};

/// One predictor in one run. Depends on nothing but its order, the program and the model.
struct LinkRun {
    std::string scenario;
    std::string configuration_hash;
    std::uint64_t study_seed = 0;
    std::uint32_t replication = 0;
    std::string predictor;
    std::vector<LinkCase> cases;

    bool operator==(const LinkRun&) const = default;
};

/// Wall time that a predictor took, in a file of its own beside the LinkRun.
struct LinkTiming {
    struct Case {
        std::string failure;
        Exits exits = Exits::known;
        std::uint64_t reports = 0;
        std::uint64_t vehicles = 0;  ///< In the observations, summed over reports.
        double predict_s = 0.0;
    };
    std::vector<Case> cases;
};

inline constexpr const char* link_run_extension = ".links";

/// Both files, the timing first, each whole or not at all: where the LinkRun is, the run is finished. Throws
/// core::EnvironmentError.
void write_link_run(const std::filesystem::path& file, const LinkRun& run, const LinkTiming& timing);
/// Throw core::InputError, naming the file and what to do, for files that are missing or damaged.
LinkRun read_link_run(const std::filesystem::path& file);
LinkTiming read_link_timing(const std::filesystem::path& link_run_file);

}  // namespace clearway::links
