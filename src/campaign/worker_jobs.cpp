#include "campaign/worker_jobs.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "campaign/programs.hpp"
#include "core/files.hpp"
#include "core/fork_server.hpp"
#include "core/progress.hpp"
#include "core/supervisor.hpp"
#include "samples/dataset_plan.hpp"

namespace clearway::campaign {
namespace {

class JobList : public core::TaskList {
  public:
    JobList(const std::vector<WorkerJob>& jobs, const std::string& title)
        : jobs_(jobs),
          logs_(jobs.size()),
          program_(worker_program()),
          progress_(title, jobs.size(), core::Progress::style_for_stderr()) {}

    std::optional<core::Task> next() override {
        if (next_ == jobs_.size()) return std::nullopt;
        const WorkerJob& job = jobs_[next_];
        core::make_folder(job.file.parent_path());
        core::write_atomically(job.file, experiment::to_json(job.job));
        // Absolute: no folder's name then reads as an option.
        return core::Task{
            .id = next_++,
            .command = {
                .program = program_, .arguments = {std::filesystem::absolute(job.file)}, .output = job.log}};
    }

    void ended(const core::TaskEnd& end) override {
        const WorkerJob& job = jobs_[end.id];
        const bool interrupted = end.ended_by == core::EndedBy::interruption;
        if (!interrupted) ++done_;
        if (end.exit.ok()) {
            logs_[end.id] = job.log;
            return;
        }
        if (interrupted) {
            remove_work(job);
        } else {
            report_failure(job, end.exit);
        }
    }

    void tick(std::span<const std::size_t>) override { progress_.update(done_, failed_); }

    /// To be called once, at the end.
    WorkerResult result(const core::InterruptionWatch& interruption) {
        progress_.finish();
        return {interruption.exit_code(exit_code_), lines()};
    }

  private:
    void report_failure(const WorkerJob& job, const core::Exit& exit) {
        ++failed_;
        const std::string words = core::tail(job.log, shown_lines);
        remove_work(job);  // this often removes the log too
        const bool is_kept = std::filesystem::exists(job.log);
        fmt::print(stderr, "\nclearway: {}: {}{}\n{}", job.label, exit.describe(),
                   is_kept ? fmt::format(" ({})", job.log.string()) : "", words);
        constexpr int not_loaded = 127;
        if (exit.signal != 0 || exit.code == not_loaded)
            fmt::print(stderr, "clearway: give the same command again, in case the machine failed\n");
        if (exit_code_ == core::ExitCode::ok) exit_code_ = exit_code_of(exit);
    }

    std::vector<std::string> lines() const {
        std::vector<std::string> all;
        for (const std::filesystem::path& log : logs_) {
            if (log.empty()) continue;
            std::istringstream stream(core::read_file(log));
            for (std::string line; std::getline(stream, line);)
                all.push_back(line);
        }
        return all;
    }

    static void remove_work(const WorkerJob& job) {
        std::error_code ignored;
        for (const std::filesystem::path& place : job.work)
            std::filesystem::remove_all(place, ignored);
    }

    const std::vector<WorkerJob>& jobs_;
    std::vector<std::filesystem::path> logs_;  ///< Of jobs that succeeded; empty otherwise.
    std::string program_;
    core::Progress progress_;
    std::size_t next_ = 0;
    std::size_t done_ = 0;
    std::size_t failed_ = 0;
    core::ExitCode exit_code_ = core::ExitCode::ok;
};

}  // namespace

experiment::RunJob stored_job(const results::Store& store, const experiment::RunKey& key,
                              const std::filesystem::path& output) {
    const auto& conditions = store.manifest().conditions;
    const auto condition = std::ranges::find(conditions, key.condition, &experiment::ConditionSpec::name);
    const std::filesystem::path scenario = std::filesystem::absolute(store.scenario_folder(key.scenario));
    experiment::RunJob job;
    job.scenario = key.scenario;
    job.scenario_file = scenario / "scenario.toml";
    job.network_folder = scenario / "network";
    job.study_seed = store.manifest().study_seed;
    job.replication = key.replication;
    job.traffic_model = condition->traffic_model;
    job.conditions = {*condition};
    job.output = std::filesystem::absolute(output);
    return job;
}

core::ExitCode exit_code_of(const core::Exit& exit) {
    constexpr std::array told = {core::ExitCode::bad_input, core::ExitCode::environment,
                                 core::ExitCode::incomplete, core::ExitCode::conflict};
    if (exit.code == program_not_started) return core::ExitCode::environment;
    const auto code = static_cast<core::ExitCode>(exit.code);
    if (exit.signal == 0 && core::contains(told, code)) return code;
    return core::ExitCode::runs_failed;
}

WorkerResult work_on(const std::vector<WorkerJob>& jobs, unsigned processes, const std::string& title) {
    const core::InterruptionWatch interruption;
    JobList list(jobs, title);
    core::ForkServer server(worker_program());
    core::Machine& machine = jobs.size() > 1 ? server : core::this_machine();
    core::Supervisor({.processes = processes}, machine).run(list, interruption);
    return list.result(interruption);
}

WorkerResult record_jobs(const std::vector<experiment::DatasetJob>& jobs, unsigned processes) {
    std::vector<WorkerJob> work;
    for (const experiment::DatasetJob& job : jobs) {
        const std::filesystem::path file = samples::job_file(job);
        work.push_back({.label = fmt::format("{} replication {}", job.scenario, job.replication),
                        .job = job,
                        .file = file,
                        .log = std::filesystem::path(file).replace_extension(".log"),
                        .work = {samples::work_folder(job)}});
    }
    WorkerResult result = work_on(work, processes, "recordings");
    // Libraries write to the same streams.
    std::erase_if(result.lines,
                  [&](const std::string& line) { return !line.starts_with(jobs.front().output.string()); });
    return result;
}

}  // namespace clearway::campaign
