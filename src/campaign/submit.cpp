#include "campaign/submit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "campaign/plan_text.hpp"
#include "campaign/printout.hpp"
#include "campaign/study_run.hpp"
#include "core/counted.hpp"
#include "core/files.hpp"
#include "core/interruption.hpp"
#include "core/leftovers.hpp"
#include "core/own_output.hpp"
#include "core/process.hpp"
#include "core/read_failure.hpp"
#include "results/store.hpp"
#include "scenario/prepare.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;

/// A file of the user may have the name of one of a submission, so it has a mark of its own.
const core::OwnFolder own_folder = {"clearway study submit", {".clearway-submission"}};
/// Holds the number of shards.
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

/// Throws core::InputError when a submission is divided into another number of shards: those of two divisions
/// would repeat much work.
void require_same_division(const fs::path& folder, const std::string& wanted) {
    const fs::path file = folder / shards_file;
    if (!fs::exists(file)) return;
    const std::string held = core::read_file(file);
    if (held == wanted) return;
    throw core::InputError({folder.string(),
                            fmt::format("is already divided into {} shards, not {}",
                                        held.substr(0, held.find('\n')), wanted.substr(0, wanted.find('\n'))),
                            "the same --shards, or another folder", "Choose another folder with --out"});
}

/// The run folders of a submission, sorted: those of its shards and the merged one.
std::set<fs::path> run_folders_of(const fs::path& folder) {
    std::set<fs::path> folders;
    const fs::path shards = folder / "shards";
    std::error_code error;
    for (auto entry = fs::directory_iterator(shards, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        if (fs::exists(entry->path() / "manifest.json")) folders.insert(entry->path());
    }
    if (error && error != std::errc::no_such_file_or_directory) core::fail_to_read(shards, error.value());
    if (fs::exists(folder / "merged" / "manifest.json")) folders.insert(folder / "merged");
    return folders;
}

/// Throws core::InputError, as its shards would one by one, when a submission holds another study, or this
/// one with more replications.
void require_continues(const fs::path& folder, const results::Manifest& wanted) {
    for (const fs::path& held : run_folders_of(folder))
        results::Store::require_fits(held, wanted);
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
    const auto left = estimated_time_left(plan, request.out, 1);
    const auto time_s = left ? std::optional(left->wall_s) : std::nullopt;
    study::Submission submission;
    submission.engine = request.engine;
    submission.shards = shard_count(request, plan, time_s);
    submission.program = core::program_folder() / "clearway";
    submission.study = fs::absolute(study::study_file(request.file));
    submission.folder = fs::absolute(request.out);
    submission.shard_limit_s =
        std::max(least_limit_s, limit_factor * time_s.value_or(0.0) / submission.shards);
    submission.study_options = limit_options(request.limits);
    return submission;
}

void write_scripts(const fs::path& folder, const std::vector<study::Script>& scripts) {
    for (const study::Script& script : scripts) {
        const fs::path file = folder / script.name;
        core::write_output(file, script.text);
        fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
    }
}

/// Checks that the folder may be submitted into before it writes anything.
void write_submission(const study::Submission& submission, const results::Manifest& manifest) {
    scenario::refuse_commas(submission.folder);
    const std::vector<study::Script> scripts = study::scripts_of(submission);
    const std::string division = fmt::format("{}\n", submission.shards);
    core::require_own(submission.folder, own_folder);
    require_same_division(submission.folder, division);
    require_continues(submission.folder, manifest);
    core::claim(submission.folder, own_folder);
    core::write_output(submission.folder / shards_file, division);
    write_scripts(submission.folder, scripts);
}

/// Runs submit.sh. A signal is passed on, and the script ends first, after its shards.
core::ExitCode run_script(const fs::path& script) {
    constexpr std::chrono::milliseconds pause(20);
    const core::InterruptionWatch interruption;
    const core::Child child = core::start({.program = "bash", .arguments = {script.string()}});
    bool told = false;
    std::optional<core::Exit> exit = core::poll(child);
    while (!exit) {
        if (!told && interruption.signal() != 0) {
            ::kill(child.pid, SIGTERM);
            told = true;
        }
        std::this_thread::sleep_for(pause);
        exit = core::poll(child);
    }
    return interruption.exit_code(exit->signal != 0 ? core::ExitCode::terminated
                                                    : static_cast<core::ExitCode>(exit->code));
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
    write_submission(submission, plan.manifest);
    print_submission(submission, plan, request.printing);
    std::fflush(stdout);
    if (request.start == SubmitRequest::Start::write_only) return core::ExitCode::ok;
    return run_script(submission.folder / "submit.sh");
}

}  // namespace clearway::campaign
