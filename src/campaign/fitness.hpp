#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "campaign/study_run.hpp"
#include "core/json.hpp"
#include "results/record.hpp"
#include "roads/network.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {

/// What a finding means for a comparison of policies on a scenario.
enum class Grade : std::uint8_t { ok, note, falls_short, failed };
/// `ok`, `note`, `short`, `FAILED`.
const char* word_of(Grade grade);

/// One line of `clearway scenario check`.
struct Finding {
    std::string name;
    Grade grade = Grade::ok;
    std::string text;
    std::string advice = {};  ///< What to do about it; empty where there is nothing to do.
    core::Json numbers = {};  ///< What is known besides, for JSON alone.
};

/// What traffic does on a scenario's roads.
enum class TrafficState : std::uint8_t { fits, too_empty, too_full, gridlock };

/// How a baseline run loaded its network.
struct RoadUse {
    TrafficState state = TrafficState::fits;
    /// Vehicles on the road while demand departs, mean: the time that all spent there over that time.
    double per_lane_km = 0.0;
    /// By which the present density is to be multiplied; 1 where it fits.
    double factor = 1.0;
};

/// Judges a baseline run that went to its end. Gridlock: more than a tenth have not arrived, or 1 % have not
/// and 1 % were teleported. Too full: more than a tenth never entered, or 1 % teleported or did not arrive.
/// Too empty: fewer than one vehicle on two kilometres of lane, which an EV hardly ever meets.
RoadUse road_use(const metrics::RunMetrics& run, const scenario::Times& time, double lane_km);

/// A scenario that was checked.
struct Checked {
    const scenario::ScenarioConfig& config;
    const roads::Network& network;
    std::filesystem::path demand;  ///< Folder of the run's demand.
    core::Json outlook = {};       ///< scenario::outlook_json of it.
};

/// `--density 0.45`, which multiplies the scenario's own, and how to keep it. Measured demand cannot grow.
std::string density_advice(const scenario::ScenarioConfig& config, double factor);

/// The collisions of a run. `less`: how to get less traffic, where they are more than one to a hundred
/// vehicles.
Finding collisions_finding(const metrics::RunMetrics& run, double step_length_s, const std::string& less);

/// What findings come to, in a sentence.
std::string conclusion_of(const std::string& scenario, const std::vector<Finding>& findings);

/// What a run that failed says about it. Its inputs are kept in `folder`.
Finding error_finding(const results::RunError& error, const std::filesystem::path& folder);

/// Makes one run of the baseline in `runs/check-SCENARIO`, which is kept only if the run fails, judges it and
/// prints the findings. With `lock_trials` above 0 it makes as many runs more with each choice about
/// `time.ignore_junction_blocker_s`.
/// Returns ok, fell_short or runs_failed, or how the run was interrupted.
core::ExitCode check_scenario(const scenario::ScenarioConfig& scenario, std::uint64_t seed,
                              std::uint32_t lock_trials, RunOptions options);

}  // namespace clearway::campaign
