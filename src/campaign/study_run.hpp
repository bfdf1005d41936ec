#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/printing.hpp"
#include "campaign/report_replays.hpp"
#include "campaign/workers.hpp"
#include "core/error.hpp"
#include "report/console.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"
#include "study/config.hpp"
#include "study/plan.hpp"
#include "study/shard.hpp"

namespace clearway::campaign {

/// How the results of a run folder are printed.
struct PublishOptions {
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    double least_relevant_s = report::usual_least_relevant_s;  ///< Smaller EV time differences do not count.
    std::string condition =
        {};  ///< That first screens show, by name or title; empty: the one that helps most.
    ReplayRequest replays = {};
    std::optional<double> response_threshold_s = {};  ///< Nothing: that of each scenario.
};

/// How a study is run and shown.
struct RunOptions {
    std::filesystem::path folder = {};  ///< Run folder; empty: a new one below `runs/`.
    std::filesystem::path reused = {};  ///< Run folder whose runs are taken over where they are the same.
    unsigned workers = 0;               ///< 0: one per core.
    experiment::RunLimits limits = {};  ///< Of each run.
    RetriedRuns retried = RetriedRuns::ended_by_machine;
    experiment::StepRecording recording = experiment::StepRecording::off;
    std::string command = {};      ///< What the user typed, for the report and for resuming.
    bool stays_if_failed = false;  ///< The caller removes the folder otherwise.
    PublishOptions publish = {};
};

/// Refuses a study with a plan whose seed was used before, as study::check_fresh_seed does, and warns on
/// standard error of run folders that cannot be read.
void check_seed(const study::StudyConfig& config, const std::filesystem::path& file,
                const std::filesystem::path& folder);

/// A study of one scenario, named after it.
study::StudyConfig study_of(scenario::ScenarioConfig scenario,
                            std::vector<experiment::ConditionSpec> conditions, std::uint64_t seed,
                            std::uint32_t replications);

/// Checks names and makes the plan with the installed versions. An empty `options.folder` becomes
/// `runs/NAME-xxxxxx` with a hash of the study, so that the same command finds its folder again and another
/// study gets another folder. Throws core::InputError, core::EnvironmentError.
study::Plan plan_for(const study::StudyConfig& config, RunOptions& options);

/// Makes the run folder of a plan, with the command, a picture of each network and, where a condition repairs
/// by a net, the losses of the shipped models. If the study turns out to be invalid, a new folder is removed,
/// so that it does not block the corrected study.
results::Store prepare_run_folder(const study::Plan& plan, const RunOptions& options);

/// Makes the missing runs of a plan, with progress and the current estimate on standard error. When
/// interrupted, it tells the user how to continue.
StudyResult run_missing(const study::Plan& plan, const results::Store& store, const RunOptions& options);
/// The same as a part of something greater: tells `on_progress` and prints none of it.
StudyResult run_part(const study::Plan& plan, const results::Store& store, const RunOptions& options,
                     const std::function<void(const StudyProgress&)>& on_progress);

/// Whether this is how a command ends that a signal interrupts.
/// What is told where a study is interrupted while it has no workers: before the first, or while its tables
/// are written.
std::string interrupted_between_runs(const std::string& command);

bool is_interrupted(core::ExitCode code);

/// Replications that a study with a precision target has reached in a folder; those of the first round if it
/// has not begun.
std::uint32_t replications_so_far(const study::StudyConfig& config, const std::filesystem::path& folder);

/// A study from its plan to its tables: plan_for, prepare_run_folder and `complete`. With a precision target
/// it runs in rounds. Each has as many replications as the variation so far requires (FHWA's rule,
/// analysis::required_replications) and is reported on standard error; the last one reaches the target or its
/// cap. A study that is continued in its folder takes the same rounds to the same results.
core::ExitCode run_study(study::StudyConfig config, RunOptions options);

/// Throws core::InputError for a part of a study with a precision target, which needs all its runs at once.
void require_divisible(const study::StudyConfig& config, const study::Shard& shard);

/// Makes the runs of a shard in its folder and prints how far it is. Throws as require_divisible does.
core::ExitCode run_shard(const study::StudyConfig& config, const study::Shard& shard, RunOptions options);

/// Makes the missing runs of a plan and publishes its folder. Returns interrupted or terminated, else as
/// publish does.
core::ExitCode complete(const study::Plan& plan, const results::Store& store, const RunOptions& options);

/// Writes the tables of a run folder, if they are not current, and its `report.html`, and prints the tables
/// on standard output. Returns ok, runs_failed when a run failed, or incomplete when one is missing.
core::ExitCode publish(const results::Store& store, const PublishOptions& options);

}  // namespace clearway::campaign
