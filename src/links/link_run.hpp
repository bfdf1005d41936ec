#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "failures/failure_config.hpp"
#include "links/link_scores.hpp"
#include "links/place_errors.hpp"

namespace clearway::links {

using failures::Exits;

/// What one predictor did in one run under one failure.
struct LinkCase {
    std::string failure;
    Exits exits = Exits::known;
    LinkTruth truth;
    LinkBelief belief;
    LinkScoreSummary scores;
    PlaceErrors places = {};  ///< Of dark vehicles that are on the road and believed.

    bool operator==(const LinkCase&) const = default;
};

/// The results of one predictor in one run. They depend only on the job, the program and the model.
struct LinkRun {
    std::string scenario;
    std::string configuration_hash;
    std::uint64_t study_seed = 0;
    std::uint32_t replication = 0;
    std::string predictor;
    std::vector<LinkCase> cases;

    bool operator==(const LinkRun&) const = default;
};

/// Wall time that a predictor took, in a separate file next to the LinkRun.
struct LinkTiming {
    struct Case {
        std::string failure;
        Exits exits = Exits::known;
        std::uint64_t reports = 0;
        std::uint64_t vehicles = 0;  ///< Vehicles in the observations, summed over reports.
        double predict_s = 0.0;
    };
    std::vector<Case> cases;
};

inline constexpr const char* link_run_extension = ".links";

/// Where the timing of a run lies.
std::filesystem::path timing_file(std::filesystem::path link_run_file);

/// Writes both files atomically, the timing first: when the LinkRun exists, the run is finished. Throws
/// core::EnvironmentError.
void write_link_run(const std::filesystem::path& file, const LinkRun& run, const LinkTiming& timing);
/// Both throw core::InputError, naming the file and what to do, for files that are missing or damaged.
LinkRun read_link_run(const std::filesystem::path& file);
LinkTiming read_link_timing(const std::filesystem::path& link_run_file);

}  // namespace clearway::links
