#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaign/printing.hpp"
#include "cli/detail/app.hpp"
#include "results/run_limit.hpp"

// What verbs hand on. Its headers are long, and a verb needs few of them.
namespace clearway::campaign {
struct Publication;
enum class RetriedRuns : std::uint8_t;
}  // namespace clearway::campaign
namespace clearway::experiment {
struct LinkSettings;
struct RunLimits;
enum class StepRecording : std::uint8_t;
}  // namespace clearway::experiment
namespace clearway::report {
enum class Tables : std::uint8_t;
}  // namespace clearway::report

namespace clearway::cli {

using campaign::Printing;
using results::most_replications;

inline constexpr std::uint32_t usual_seeds = 10;  // FHWA's minimum number of replications

/// Of verbs that can say what they would run.
enum class Mode : std::uint8_t { run, dry_run };

/// Declares `--json`; `what` completes "Print ... as JSON".
void add_json_option(App& app, Printing& printing, const std::string& what);
/// Declares `--tables`: every measure is printed.
void add_tables_option(App& app, report::Tables& tables);
/// Declares `--response-threshold`.
void add_response_option(App& app, std::optional<double>& threshold_s);
/// Declares `--condition`: the one that first screen, map, trip, journeys and replays show.
void add_shown_condition_option(App& app, std::string& condition);
/// Declares `--record`: every step of every run is kept in a file.
void add_record_option(App& app, experiment::StepRecording& recording);
/// Declares `--jobs`: worker processes at a time, 0 for one per core.
void add_jobs_option(App& app, unsigned& jobs);
/// Declares `--seed`: the study seed, from which every random number of every replication follows.
Option add_seed_option(App& app, std::uint64_t& seed);
/// Declares `--seeds`: number of replications; the help shows the current value as the default.
Option add_seeds_option(App& app, std::uint32_t& seeds);

/// Declares `--within`: wall time, s, for as many seeds as it allows.
Option add_within_option(App& app, double& within_s);

/// Declares `--run-time-limit` and `--memory-limit`: what a run may use before it is ended as failed.
void add_limit_options(App& app, experiment::RunLimits& limits);

/// Declares `--most-runs`: a study with more is refused.
void add_most_runs_option(App& app, std::uint64_t& most_runs);
/// Declares `--retry-failed`: runs that their input made fail are tried again, too.
void add_retry_option(App& app, campaign::RetriedRuns& retried);

/// Declares `--publish`, `--tree` and `--behaviour`: rows of `results/`.
void add_publish_options(App& app, campaign::Publication& publication);

/// `--link-radius` and `--automated-links`.
std::vector<Option> add_link_options(App& app, experiment::LinkSettings& links);

}  // namespace clearway::cli
