#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "campaign/printout.hpp"
#include "campaign/publication.hpp"
#include "campaign/workers.hpp"
#include "experiment/loop_config.hpp"
#include "experiment/run_job.hpp"
#include "report/console.hpp"
#include "results/run_limit.hpp"

namespace clearway::cli {

using campaign::Printing;

/// While it lives, options that are declared stand in this group of the help.
class OptionGroup {
  public:
    OptionGroup(CLI::App& app, const std::string& name)
        : defaults_(*app.option_defaults()), before_(defaults_.get_group()) {
        defaults_.group(name);
    }
    ~OptionGroup() { defaults_.group(before_); }
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

  private:
    CLI::OptionDefaults& defaults_;
    std::string before_;
};

using results::most_replications;

/// Declares `--json`; `what` completes "Print ... as JSON".
void add_json_option(CLI::App& app, Printing& printing, const std::string& what);
/// Declares `--tables`: every measure is printed.
void add_tables_option(CLI::App& app, report::Tables& tables);
/// Declares `--response-threshold`.
void add_response_option(CLI::App& app, std::optional<double>& threshold_s);
/// Declares `--record`: every step of every run is kept in a file.
void add_record_option(CLI::App& app, experiment::StepRecording& recording);
/// Declares `--jobs`: worker processes at a time, 0 for one per core.
void add_jobs_option(CLI::App& app, unsigned& jobs);
/// Declares `--seed`: the study seed, from which every random number of every replication follows.
CLI::Option* add_seed_option(CLI::App& app, std::uint64_t& seed);
/// Declares `--seeds`: number of replications; the help shows the current value as the default.
CLI::Option* add_seeds_option(CLI::App& app, std::uint32_t& seeds);

/// Declares `--run-time-limit` and `--memory-limit`: what a run may use before it is ended as failed.
void add_limit_options(CLI::App& app, experiment::RunLimits& limits);

/// Declares `--most-runs`: a study with more is refused.
void add_most_runs_option(CLI::App& app, std::uint64_t& most_runs);
/// Declares `--retry-failed`: runs that their input made fail are tried again, too.
void add_retry_option(CLI::App& app, campaign::RetriedRuns& retried);

/// Declares `--publish`, `--tree` and `--behaviour`: rows of `results/`.
void add_publish_options(CLI::App& app, campaign::Publication& publication);

/// `--link-radius` and `--automated-links`.
std::vector<CLI::Option*> add_link_options(CLI::App& app, experiment::LinkSettings& links);

}  // namespace clearway::cli
