#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/worker_jobs.hpp"
#include "links/link_benchmark.hpp"
#include "report/links.hpp"

namespace clearway::cli {

/// A predictor to judge.
struct LinkPredictor {
    std::string name;
    std::string model_file;   ///< Empty: as shipped.
    core::Settings settings;  ///< That differ from the defaults.
};

/// On which seeds figures are taken. Thresholds are always chosen on the validation seeds.
enum class LinkSplit { test, validation };

/// What `clearway links evaluate` does.
struct LinkPlan {
    links::LinkBenchmark benchmark;
    std::vector<LinkPredictor> predictors;
    LinkSplit split = LinkSplit::test;
    std::string against;  ///< Empty: the best kinematic predictor of the plan.
    std::filesystem::path folder;
    unsigned jobs = 0;
};

/// Checks names and settings. Throws core::InputError with all problems.
void check(const LinkPlan& plan);

/// Does the runs that `plan.folder` lacks: `runs/SCENARIO/REPLICATION/PREDICTOR-KEY.links`, where the key
/// follows from everything that the content depends on, this program's worker included.
core::ExitCode complete_runs(const LinkPlan& plan);

/// Reads the runs and judges. All are complete. Throws core::InputError for a damaged one.
report::LinkFacts judge(const LinkPlan& plan);

}  // namespace clearway::cli
