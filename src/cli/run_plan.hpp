#pragma once

#include <filesystem>
#include <string>

#include "cli/common_options.hpp"
#include "core/error.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"
#include "study/config.hpp"
#include "study/plan.hpp"
#include "study/runner.hpp"

namespace clearway::cli {

/// How a study is run and shown.
struct RunPlanOptions {
    std::filesystem::path folder;  ///< Run folder; empty: one of its own below `runs/`.
    unsigned workers = 0;          ///< 0: one per core.
    experiment::RunLimits limits;  ///< Of each run.
    Printing printing = Printing::text;
    std::string command;  ///< What the user typed, for the report and for resuming.
    experiment::StepRecording recording = experiment::StepRecording::off;
    report::Tables tables = report::Tables::essential;
};

/// How the results of a run folder are printed.
struct PublishOptions {
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    double least_relevant_s = report::usual_least_relevant_s;  ///< Smaller EV time differences are no effect.
};

/// Checks names, makes the plan with the versions installed and settles an empty `options.folder`:
/// `runs/NAME-xxxxxx`, where the digits follow from what the study is, so that the same command finds its
/// folder again and another one never meets it. Throws core::InputError, core::EnvironmentError.
study::Plan plan_for(const study::StudyConfig& config, RunPlanOptions& options);

/// Makes the run folder of a plan, with the command, a picture of each network and the losses of the shipped
/// models. What was made in a new folder for a study that does not work out is taken back, so that it is not
/// in the way of the corrected one.
results::Store prepare_run_folder(const study::Plan& plan, const RunPlanOptions& options);

/// Runs what is missing of a plan, with progress and the present estimate on standard error. Interrupted, it
/// says how to go on.
study::StudyResult run_missing(const study::Plan& plan, const results::Store& store,
                               const RunPlanOptions& options);

/// Whether a study was ended by a signal.
bool was_interrupted(const study::StudyResult& result);

/// Both, then writes tables and report and prints the tables. Answers ok, runs_failed, interrupted or
/// terminated.
core::ExitCode run_and_print(const study::Plan& plan, const RunPlanOptions& options);

/// Writes the tables, where they are not current, and `report.html` of a run folder from its runs, and prints
/// them on standard output. Answers ok, runs_failed when a run failed, incomplete when one is missing.
core::ExitCode publish(const results::Store& store, const PublishOptions& options);

}  // namespace clearway::cli
