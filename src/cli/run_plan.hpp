#pragma once

#include <filesystem>
#include <string>

#include "cli/common_options.hpp"
#include "core/error.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"
#include "study/config.hpp"
#include "study/plan.hpp"

namespace clearway::cli {

/// How a study is run and shown.
struct RunPlanOptions {
    std::filesystem::path folder;  ///< Run folder; empty: one of its own below `runs/`.
    unsigned workers = 0;          ///< 0: one per core.
    Printing printing = Printing::text;
    std::string command;  ///< What the user typed, for the report and for resuming.
    results::StepRecording recording = results::StepRecording::off;
};

/// Checks names, makes the plan with the versions installed and settles an empty `options.folder`:
/// `runs/NAME-xxxxxx`, where the digits follow from what the study is, so that the same command finds its
/// folder again and another one never meets it. Throws core::InputError, core::EnvironmentError.
study::Plan plan_for(const study::StudyConfig& config, RunPlanOptions& options);

/// Runs what is missing of a plan, with progress on standard error; adds to the run folder the command, a
/// picture of each network and the losses of the shipped models; then writes tables and report and prints the
/// tables. Interrupted, it says how to go on. Answers ok, runs_failed, interrupted or terminated.
core::ExitCode run_and_print(const study::Plan& plan, const RunPlanOptions& options);

/// Writes the tables, where they are not current, and `report.html` of a run folder from its runs, and prints
/// the tables on standard output. EV times that differ by less than `least_relevant_s` are no effect. Answers
/// ok, runs_failed when a run failed, incomplete when one is missing.
core::ExitCode publish(const results::Store& store, Printing printing,
                       double least_relevant_s = report::usual_least_relevant_s);

}  // namespace clearway::cli
