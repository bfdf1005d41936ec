#include "campaign/workers.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "campaign/detail/run_cost.hpp"
#include "campaign/programs.hpp"
#include "core/files.hpp"
#include "core/fork_server.hpp"
#include "core/supervisor.hpp"
#include "experiment/job.hpp"
#include "study/folder_lock.hpp"
#include "study/work_estimate.hpp"

namespace clearway::campaign {
namespace {

using core::ExitCode;
using experiment::RunKey;
using results::ErrorCause;

constexpr auto progress_period = std::chrono::milliseconds(250);
/// Of a worker that could not even write into its log.
constexpr const char* speechless =
    "Perhaps the disk is full. Free some space there and give the same command again";
constexpr int log_lines = 30;

RunKey key_of(const experiment::RunJob& unit, const experiment::ConditionSpec& condition) {
    return {unit.scenario, condition.name, unit.replication};
}

/// Cause of the errors of runs that a worker left without a record.
ErrorCause cause_of(const core::TaskEnd& end) {
    if (end.ended_by == core::EndedBy::time_limit) return ErrorCause::time_limit;
    if (end.ended_by == core::EndedBy::memory_limit) return ErrorCause::memory;
    if (end.exit.signal != 0) return ErrorCause::signal;
    if (end.exit.code == static_cast<int>(ExitCode::bad_input)) return ErrorCause::bad_input;
    return ErrorCause::other;
}

/// `: ` and what a worker said last, its name first; nothing where its log has none of it.
std::string last_message_in(std::string log) {
    constexpr std::string_view name = "clearway-run: ";
    const std::size_t begin = log.rfind(name);
    if (begin == std::string::npos || (begin > 0 && log[begin - 1] != '\n')) return "";
    while (log.ends_with('\n'))
        log.pop_back();
    return ": " + log.substr(begin);
}

/// Of a run whose demand cannot be read or is not in the plan, s. Assumed: only the first ones are judged by
/// it.
constexpr double usual_run_s = 10.0;

/// Expected wall time of a run in each cell: scenarios in the order of the manifest, with all conditions
/// each.
std::vector<study::WorkEstimate::Expected> expected_costs(const study::Plan& plan, const CostBook& book) {
    std::vector<study::WorkEstimate::Expected> expected;
    for (std::size_t row = 0; row < plan.manifest.scenarios.size(); ++row) {
        std::map<experiment::TrafficModel, double> run_s;  // Measured demand is read once, not per condition.
        for (const experiment::ConditionSpec& condition : plan.manifest.conditions) {
            const auto [cost, is_new] = run_s.try_emplace(condition.traffic_model, usual_run_s);
            if (is_new && row < plan.scenarios.size())
                cost->second =
                    book.of(plan.scenarios[row], plan.manifest.scenarios[row].configuration_hash, cost->first)
                        .wall_s.value_or(usual_run_s);
            expected.push_back({cost->second, static_cast<std::size_t>(cost->first)});
        }
    }
    return expected;
}

/// The state of one call of `run_units`.
class Workers : private core::TaskList {
  public:
    Workers(const study::Plan& plan, const results::Store& store, const WorkersOptions& options,
            const std::function<void(const StudyProgress&)>& on_progress)
        : plan_(plan),
          store_(store),
          options_(options),
          on_progress_(on_progress),
          lock_(store.folder()),
          work_(expected_costs(plan, CostBook(store.folder()))) {
        if (options_.worker_program.empty()) {
            options_.worker_program = core::program_folder() / "clearway-run";
            server_.emplace(options_.worker_program, *options_.machine);
            if (plan.units.size() > 1) options_.machine = &*server_;
        }
        core::make_folder(store.unit_file("").parent_path());
        core::make_folder(store.log_file("").parent_path());
        attempts_.resize(plan.units.size(), 0);
        began_.resize(plan.units.size());
        open_cells_.resize(plan.units.size());
        set_damaged_aside();
        queue_units();
    }

    StudyResult run() {
        core::Supervisor({options_.workers, options_.termination_grace_s}, *options_.machine)
            .run(*this, interruption_);
        store_.remove_leftovers();
        report({});
        return {interruption_.exit_code(progress_.failed > 0 ? ExitCode::runs_failed : ExitCode::ok),
                progress_};
    }

  private:
    /// Conditions of a unit that have no record, and no error or one that is to be tried again.
    template <class IsRetried>
    std::vector<experiment::ConditionSpec> open_conditions(const experiment::RunJob& unit,
                                                           const IsRetried& is_retried) const {
        std::vector<experiment::ConditionSpec> open;
        for (const experiment::ConditionSpec& condition : unit.conditions) {
            const RunKey key = key_of(unit, condition);
            if (store_.done(unit, condition)) continue;
            const auto error = store_.read_error(key);
            if (!error || is_retried(error->cause)) open.push_back(condition);
        }
        return open;
    }

    void set_damaged_aside() {
        std::vector<RunKey> keys, recorded;
        for (const study::PlannedUnit& planned : plan_.units) {
            for (const experiment::ConditionSpec& condition : planned.unit.conditions)
                keys.push_back(key_of(planned.unit, condition));
            if (planned.unit.recording == experiment::StepRecording::on)
                recorded.insert(recorded.end(), keys.end() - std::ssize(planned.unit.conditions), keys.end());
        }
        for (const auto& moved :
             {store_.set_damaged_aside(keys), store_.set_damaged_recordings_aside(recorded)})
            for (const results::SetAside& damaged : moved)
                if (options_.on_set_aside) options_.on_set_aside(damaged);
    }

    bool is_complete(const experiment::RunJob& unit) const {
        return std::ranges::all_of(unit.conditions, [&](const experiment::ConditionSpec& condition) {
            return store_.complete(key_of(unit, condition));
        });
    }

    /// What a worker left that was killed when its runs were complete.
    void remove_work(const std::string& unit) const {
        std::error_code ignored;
        std::filesystem::remove_all(store_.work_folder(unit), ignored);
    }

    void queue_units() {
        const auto is_retried = [this](ErrorCause cause) {
            return options_.retried == RetriedRuns::all_failed || results::may_pass(cause);
        };
        for (std::size_t job = 0; job < plan_.units.size(); ++job) {
            const experiment::RunJob& unit = plan_.units[job].unit;
            const auto open = open_conditions(unit, is_retried);
            if (!open.empty())
                queue_.push_back(job);
            else if (is_complete(unit))
                remove_work(plan_.units[job].name);
            for (const experiment::ConditionSpec& condition : open) {
                open_cells_[job].emplace(condition.name, cell_of(unit.scenario, condition.name));
                work_.add(open_cells_[job].at(condition.name));
            }
            forget_errors(unit, open);
            count(unit, settled_);
        }
        progress_.total = plan_.run_count();
        progress_.resumed = settled_.complete;
        lock_.note(settled_.complete + settled_.failed);
    }

    std::size_t cell_of(const std::string& scenario, const std::string& condition) const {
        const auto& scenarios = plan_.manifest.scenarios;
        const auto row = std::ranges::find(scenarios, scenario, &results::ScenarioEntry::name);
        const auto& conditions = plan_.manifest.conditions;
        const auto column = std::ranges::find(conditions, condition, &experiment::ConditionSpec::name);
        return static_cast<std::size_t>(row - scenarios.begin()) * conditions.size() +
               static_cast<std::size_t>(column - conditions.begin());
    }

    /// Moves the runs of a unit that have ended from what is open to what is done.
    void end_work(std::size_t row) {
        std::erase_if(open_cells_[row], [&](const auto& open) {
            const RunKey key{plan_.units[row].unit.scenario, open.first, plan_.units[row].unit.replication};
            const bool is_complete = store_.complete(key);
            if (!is_complete && !store_.read_error(key)) return false;
            const auto timing = is_complete ? store_.read_timing(key) : std::nullopt;
            work_.end(open.second, timing ? timing->wall_s : work_.run_s(open.second));
            return true;
        });
    }

    /// What a unit that runs has done: its time so far, but never all of what it is expected to take.
    double running_work_s(std::size_t row) const {
        constexpr double most = 0.9;
        double expected_s = 0.0;
        for (const auto& [condition, cell] : open_cells_[row])
            expected_s += work_.run_s(cell);
        const std::chrono::duration<double> so_far = std::chrono::steady_clock::now() - began_[row];
        return std::min(so_far.count(), most * expected_s);
    }

    void forget_errors(const experiment::RunJob& unit,
                       const std::vector<experiment::ConditionSpec>& conditions) const {
        for (const experiment::ConditionSpec& condition : conditions)
            store_.forget_error(key_of(unit, condition));
    }

    std::optional<core::Task> next() override {
        if (queue_.empty()) return std::nullopt;
        const std::size_t row = queue_.front();
        queue_.pop_front();
        const study::PlannedUnit& planned = plan_.units[row];
        experiment::RunJob job = planned.unit;
        uncount(job, settled_);
        job.conditions = open_conditions(job, results::worth_retrying);
        job.limits = options_.limits;
        forget_errors(job, job.conditions);
        ++attempts_[row];
        began_[row] = std::chrono::steady_clock::now();
        const auto file = store_.unit_file(planned.name);
        core::write_atomically(file, experiment::to_json(job));
        const auto places = static_cast<double>(job.conditions.size() + 1);  // one for the shared warm-up
        return core::Task{.id = row,
                          .command = {.program = options_.worker_program,
                                      // Absolute: no folder's name then reads as an option.
                                      .arguments = {std::filesystem::absolute(file)},
                                      .output = log_file(row)},
                          .limits = {options_.limits.wall_s * places, options_.limits.memory_mib}};
    }

    std::filesystem::path log_file(std::size_t job) const {
        const std::string& name = plan_.units[job].name;
        return store_.log_file(attempts_[job] <= 1 ? name : fmt::format("{}.{}", name, attempts_[job]));
    }

    void ended(const core::TaskEnd& end) override {
        const experiment::RunJob& unit = plan_.units[end.id].unit;
        if (end.ended_by == core::EndedBy::interruption) return count(unit, settled_);
        stop_if_environment(end);
        bool retry = false;
        for (const experiment::ConditionSpec& condition : unit.conditions) {
            const RunKey key = key_of(unit, condition);
            if (!store_.complete(key)) retry = settle(end, key) || retry;
        }
        if (retry) queue_.push_front(end.id);
        count(unit, settled_);
        end_work(end.id);
    }

    /// Records why a run has no result, or returns true when it should be tried again.
    bool settle(const core::TaskEnd& end, const RunKey& key) const {
        auto error = store_.read_error(key);
        const bool told_by_worker = error.has_value();
        if (!error) error = error_of(key, end);
        if (!results::worth_retrying(error->cause)) {
            if (!told_by_worker) store_.write(*error);
            return false;
        }
        if (attempts_[end.id] < options_.attempts) return true;
        error->attempts = attempts_[end.id];
        if (told_by_worker) error->log_tail += core::tail(log_file(end.id), log_lines);
        store_.write(*error);
        return false;
    }

    void stop_if_environment(const core::TaskEnd& end) {
        const int code = end.exit.code;
        if (end.exit.signal != 0) return;
        if (code == program_not_started)
            throw core::EnvironmentError(fmt::format("{} cannot be started. {}",
                                                     options_.worker_program.string(), cure_of_no_start()));
        if (code == static_cast<int>(ExitCode::environment)) {
            const std::string said = core::tail(log_file(end.id), log_lines);
            throw core::EnvironmentError(
                fmt::format("a worker could not continue; completed runs are kept in {}\n{}",
                            store_.folder().string(), said.empty() ? speechless : said));
        }
        if (code == static_cast<int>(ExitCode::conflict))
            throw core::ConflictError(core::tail(log_file(end.id), log_lines));
    }

    /// The error of a run for which its worker left no record.
    results::RunError error_of(const RunKey& key, const core::TaskEnd& end) const {
        results::RunError error;
        error.key = key;
        error.cause = cause_of(end);
        error.exit_code = end.exit.code;
        error.signal = end.exit.signal;
        error.attempts = attempts_[end.id];
        error.log_tail = core::tail(log_file(end.id), log_lines);
        error.command =
            core::shell_text({options_.worker_program.string(),
                              std::filesystem::absolute(store_.unit_file(plan_.units[end.id].name))});
        error.message = message_of(end);
        return error;
    }

    std::string message_of(const core::TaskEnd& end) const {
        if (end.ended_by == core::EndedBy::time_limit)
            return fmt::format("its unit did not end within {:g} s per run", options_.limits.wall_s);
        if (end.ended_by == core::EndedBy::memory_limit)
            return fmt::format("the warm-up needed more than {} MiB", options_.limits.memory_mib);
        if (end.exit.signal != 0) return "the worker was " + end.exit.describe();
        if (end.exit.ok()) return "the worker ended without a record of this run";
        return "the worker ended with " + end.exit.describe() +
               last_message_in(core::tail(log_file(end.id), log_lines));
    }

    struct Counts {
        std::size_t complete = 0;
        std::size_t failed = 0;
    };
    Counts counts_of(const experiment::RunJob& unit) const {
        Counts counts;
        for (const experiment::ConditionSpec& condition : unit.conditions) {
            const RunKey key = key_of(unit, condition);
            if (store_.complete(key)) {
                ++counts.complete;
            } else if (store_.read_error(key)) {
                ++counts.failed;
            }
        }
        return counts;
    }
    void count(const experiment::RunJob& unit, Counts& total) const {
        const Counts counts = counts_of(unit);
        total.complete += counts.complete;
        total.failed += counts.failed;
    }
    void uncount(const experiment::RunJob& unit, Counts& total) const {
        const Counts counts = counts_of(unit);
        total.complete -= counts.complete;
        total.failed -= counts.failed;
    }

    void tick(std::span<const std::size_t> running) override {
        if (std::chrono::steady_clock::now() - reported_ >= progress_period) report(running);
    }

    void report(std::span<const std::size_t> running) {
        reported_ = std::chrono::steady_clock::now();
        Counts counts = settled_;
        double work_s = work_.done_s();
        for (const std::size_t row : running) {
            count(plan_.units[row].unit, counts);
            work_s += running_work_s(row);
        }
        const double all_s = work_.total_s();
        // At an interruption what ran is lost: the last share stays, else the time left by it would leap.
        if (!running.empty() || interruption_.signal() == 0)
            progress_.work = all_s > 0.0 ? std::min(1.0, work_s / all_s) : 1.0;
        progress_.done = counts.complete;
        progress_.failed = counts.failed;
        progress_.elapsed_s = std::chrono::duration<double>(reported_ - started_).count();
        if (on_progress_) on_progress_(progress_);
    }

    const study::Plan& plan_;
    const results::Store& store_;
    WorkersOptions options_;
    std::optional<core::ForkServer> server_;  ///< Of our own worker.
    const std::function<void(const StudyProgress&)>& on_progress_;
    study::FolderLock lock_;
    core::InterruptionWatch interruption_;
    std::deque<std::size_t> queue_;                               ///< Rows of the plan's units.
    std::vector<int> attempts_;                                   ///< By unit, in this call.
    std::vector<std::chrono::steady_clock::time_point> began_;    ///< By unit: its last attempt.
    std::vector<std::map<std::string, std::size_t>> open_cells_;  ///< By unit: cells of open conditions.
    study::WorkEstimate work_;
    Counts settled_;  ///< Runs of the units that no worker is working on.
    StudyProgress progress_;
    std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point reported_{};
};

}  // namespace

StudyResult run_units(const study::Plan& plan, const results::Store& store, const WorkersOptions& options,
                      const std::function<void(const StudyProgress&)>& on_progress) {
    return Workers(plan, store, options, on_progress).run();
}

}  // namespace clearway::campaign
