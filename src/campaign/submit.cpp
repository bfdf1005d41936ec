#include "campaign/submit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "campaign/plan_text.hpp"
#include "campaign/printout.hpp"
#include "campaign/study_run.hpp"
#include "core/counted.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/own_output.hpp"
#include "core/process.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;

/// Holds the number of shards; the first file of a submission.
constexpr const char* shards_file = "shards.txt";

/// Work per shard, s, when the user gives no number of shards: long enough to outweigh its start, short
/// enough to lose little with a node.
constexpr double usual_shard_s = 300.0;
/// Number of shards when the time cannot be estimated.
constexpr std::uint32_t usual_shards = 16;
/// Slurm's default MaxArraySize is 1001, so the largest index is 1000. Larger arrays need its administrator.
constexpr std::uint32_t most_shards = 1000;
/// Slurm's time limit for a shard as a multiple of its estimated time. The estimate is accurate to a factor
/// of three.
constexpr double limit_factor = 6.0;
constexpr double least_limit_s = 600.0;

std::uint32_t shard_count(const SubmitRequest& request, const study::Plan& plan,
                          std::optional<double> time_s) {
    const auto units = static_cast<std::uint32_t>(plan.units.size());
    if (request.shards != 0) {
        if (request.shards <= units) return request.shards;
        throw core::InputError({"--shards",
                                fmt::format("{} is more than the study has units", request.shards),
                                fmt::format("1 to {}", units), ""});
    }
    if (!time_s) return std::min(usual_shards, units);
    const double wanted = std::clamp(std::ceil(*time_s / usual_shard_s), 1.0, double{most_shards});
    return std::min(static_cast<std::uint32_t>(wanted), units);
}

/// Fixes the number of shards at the first submission: shards of two divisions would repeat much work.
void claim(const fs::path& folder, std::uint32_t shards) {
    const fs::path file = folder / shards_file;
    const std::string text = fmt::format("{}\n", shards);
    if (!fs::exists(file)) return core::write_output(file, text);
    const std::string held = core::read_file(file);
    if (held == text) return;
    throw core::InputError(
        {folder.string(),
         fmt::format("is already divided into {} shards, not {}", held.substr(0, held.find('\n')), shards),
         "the same --shards, or another folder", "Choose another folder with --out"});
}

std::vector<std::string> limit_options(const experiment::RunLimits& limits) {
    const experiment::RunLimits usual;
    std::vector<std::string> options = {"--jobs", "1"};
    if (limits.wall_s != usual.wall_s) {
        options.insert(options.end(), {"--run-time-limit", fmt::format("{}", limits.wall_s)});
    }
    if (limits.memory_mib != usual.memory_mib) {
        options.insert(options.end(), {"--memory-limit", fmt::format("{}", limits.memory_mib)});
    }
    return options;
}

/// `--model PREDICTOR=FILE` for each model that the command line has given to conditions. The path is
/// absolute, because a shard runs in another folder.
std::vector<std::string> model_options(const std::vector<experiment::ConditionSpec>& in_file,
                                       const std::vector<experiment::ConditionSpec>& conditions) {
    std::map<std::string, std::string> models;
    for (std::size_t at = 0; at < conditions.size(); ++at) {
        const experiment::ConditionSpec& condition = conditions[at];
        if (condition.model_file != in_file[at].model_file)
            models[condition.predictor] = condition.model_file;
    }
    std::vector<std::string> options;
    for (const auto& [predictor, file] : models)
        options.insert(options.end(), {"--model", predictor + "=" + file});
    return options;
}

study::Submission submission_of(const SubmitRequest& request, const study::Plan& plan) {
    const auto time_s = estimated_time_left_s(plan, request.out, 1);
    study::Submission submission;
    submission.engine = request.engine;
    submission.shards = shard_count(request, plan, time_s);
    submission.program = core::program_folder() / "clearway";
    submission.study = fs::absolute(request.file);
    submission.folder = fs::absolute(request.out);
    submission.shard_limit_s =
        std::max(least_limit_s, limit_factor * time_s.value_or(0.0) / submission.shards);
    submission.study_options = limit_options(request.limits);
    return submission;
}

void write_scripts(const study::Submission& submission) {
    for (const study::Script& script : study::scripts_of(submission)) {
        const fs::path file = submission.folder / script.name;
        core::write_output(file, script.text);
        fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
    }
}

void print_submission(const study::Submission& submission, const study::Plan& plan, Printing printing) {
    const std::string script = (submission.folder / "submit.sh").string();
    print({{{"script", script},
            {"shards", submission.shards},
            {"runs", plan.run_count()},
            {"shard_limit_s", submission.shard_limit_s}},
           {},
           fmt::format("{}: {} in {}\n", script, core::counted(plan.run_count(), "run"),
                       core::counted(submission.shards, "shard"))},
          printing);
}

}  // namespace

core::ExitCode submit(const study::StudyConfig& in_file, const study::StudyConfig& config,
                      const SubmitRequest& request) {
    if (config.precision)
        throw core::InputError({request.file, "has a precision target, which needs all its runs at once",
                                "a study with replications", "Give the number of replications"});
    check_seed(config, request.file, request.out);
    RunOptions options{.folder = request.out, .command = request.command};
    const study::Plan plan = plan_for(config, options);
    study::Submission submission = submission_of(request, plan);
    std::ranges::move(model_options(in_file.conditions, config.conditions),
                      std::back_inserter(submission.study_options));
    if (config.most_runs != results::usual_most_runs)
        submission.study_options.insert(submission.study_options.end(),
                                        {"--most-runs", fmt::format("{}", config.most_runs)});
    core::require_own(submission.folder, {"clearway study submit", {shards_file}});
    core::make_folder(submission.folder);
    claim(submission.folder, submission.shards);
    write_scripts(submission);
    print_submission(submission, plan, request.printing);
    std::fflush(stdout);
    if (request.start == SubmitRequest::Start::write_only) return core::ExitCode::ok;
    const core::Exit exit = core::run({.program = "bash", .arguments = {submission.folder / "submit.sh"}});
    return exit.signal != 0 ? core::ExitCode::terminated : static_cast<core::ExitCode>(exit.code);
}

}  // namespace clearway::campaign
