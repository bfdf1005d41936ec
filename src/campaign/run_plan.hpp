#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "campaign/printing.hpp"
#include "campaign/report_replays.hpp"
#include "core/error.hpp"
#include "report/console.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"
#include "study/config.hpp"
#include "study/plan.hpp"
#include "study/runner.hpp"

namespace clearway::campaign {

/// How a study is run and shown.
struct RunPlanOptions {
    std::filesystem::path folder;  ///< Run folder; empty: a new one below `runs/`.
    unsigned workers = 0;          ///< 0: one per core.
    experiment::RunLimits limits;  ///< Of each run.
    Printing printing = Printing::text;
    std::string command;  ///< What the user typed, for the report and for resuming.
    experiment::StepRecording recording = experiment::StepRecording::off;
    report::Tables tables = report::Tables::essential;
    std::optional<double> response_threshold_s = {};  ///< Nothing: that of each scenario.
};

/// How the results of a run folder are printed.
struct PublishOptions {
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    double least_relevant_s = report::usual_least_relevant_s;  ///< Smaller EV time differences do not count.
    MakeReplays replays = MakeReplays::no;
    std::optional<double> response_threshold_s = {};  ///< As above.
};

/// How the results of a plan's folder are printed.
inline PublishOptions how_to_publish(const RunPlanOptions& options) {
    return {.printing = options.printing,
            .tables = options.tables,
            .response_threshold_s = options.response_threshold_s};
}

/// Refuses a study with a plan whose seed was used before, as study::check_fresh_seed does, and warns on
/// standard error of run folders that cannot be read.
void check_seed(const study::StudyConfig& config, const std::filesystem::path& file,
                const std::filesystem::path& folder);

/// Checks names and makes the plan with the installed versions. An empty `options.folder` becomes
/// `runs/NAME-xxxxxx` with a hash of the study, so that the same command finds its folder again and another
/// study gets another folder. Throws core::InputError, core::EnvironmentError.
study::Plan plan_for(const study::StudyConfig& config, RunPlanOptions& options);

/// Makes the run folder of a plan, with the command, a picture of each network and the losses of the shipped
/// models. If the study turns out to be invalid, a new folder is removed, so that it does not block the
/// corrected study.
results::Store prepare_run_folder(const study::Plan& plan, const RunPlanOptions& options);

/// Makes the missing runs of a plan, with progress and the current estimate on standard error. When
/// interrupted, it tells the user how to continue.
study::StudyResult run_missing(const study::Plan& plan, const results::Store& store,
                               const RunPlanOptions& options);

/// Whether a study was ended by a signal.
bool was_interrupted(const study::StudyResult& result);

/// Calls prepare_run_folder, run_missing and publish. Returns interrupted or terminated, else as publish
/// does.
core::ExitCode run_and_print(const study::Plan& plan, const RunPlanOptions& options);

/// Writes the tables of a run folder, if they are not current, and its `report.html`, and prints the tables
/// on standard output. Returns ok, runs_failed when a run failed, or incomplete when one is missing.
core::ExitCode publish(const results::Store& store, const PublishOptions& options);

}  // namespace clearway::campaign
