#include "cli/record_orders.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "cli/interruption.hpp"
#include "cli/programs.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/progress.hpp"

namespace clearway::cli {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(20);
/// Lines of a failed worker's log that are shown.
constexpr int shown_lines = 10;

struct Worker {
    std::size_t order = 0;  ///< Index.
    core::Child child;
};

/// The worker processes of a recording.
class Recording {
  public:
    explicit Recording(const std::vector<results::DatasetOrder>& orders)
        : orders_(orders), logs_(orders.size()), program_(sister_program("clearway-run")) {}

    bool all_started() const { return next_ == orders_.size(); }
    std::size_t running() const { return workers_.size(); }
    std::size_t done() const { return done_; }
    std::size_t failed() const { return failed_; }
    core::ExitCode exit_code() const { return exit_code_; }

    void start_next() {
        const results::DatasetOrder& order = orders_[next_];
        const std::filesystem::path folder = order.scenario_file.parent_path() / "orders";
        core::make_folder(folder);
        const std::filesystem::path file = folder / fmt::format("{:04}.json", order.replication);
        logs_[next_] = folder / fmt::format("{:04}.log", order.replication);
        core::write_atomically(file, results::to_json(order));
        workers_.push_back({next_, core::start({.program = program_,
                                                .arguments = {"--dataset", file.string()},
                                                .output = logs_[next_]})});
        ++next_;
    }

    /// Collects the workers that have ended.
    void collect() {
        std::erase_if(workers_, [this](const Worker& worker) {
            const std::optional<core::Exit> exit = core::poll(worker.child);
            if (exit) note_end(worker, *exit);
            return exit.has_value();
        });
    }

    /// Ends all workers and removes what they left unfinished.
    void end_all() {
        for (const Worker& worker : workers_) {
            ::kill(worker.child.pid, SIGTERM);
        }
        for (const Worker& worker : workers_) {
            core::wait(worker.child);
            remove_work(orders_[worker.order]);
            logs_[worker.order].clear();
        }
        workers_.clear();
    }

    std::vector<std::string> lines() const {
        std::vector<std::string> all;
        for (const std::filesystem::path& log : logs_) {
            if (log.empty()) continue;
            std::istringstream stream(core::read_file(log));
            for (std::string line; std::getline(stream, line);) {
                all.push_back(line);
            }
        }
        return all;
    }

  private:
    void note_end(const Worker& worker, const core::Exit& exit) {
        ++done_;
        if (exit.ok()) return;
        ++failed_;
        const results::DatasetOrder& order = orders_[worker.order];
        remove_work(order);
        fmt::print(stderr, "\nclearway: {} replication {}: {} ({})\n{}", order.scenario, order.replication,
                   exit.describe(), logs_[worker.order].string(),
                   core::tail(logs_[worker.order], shown_lines));
        logs_[worker.order].clear();
        if (exit_code_ != core::ExitCode::ok) return;
        exit_code_ = core::ExitCode::runs_failed;
        const bool told = exit.signal == 0 && (exit.code == static_cast<int>(core::ExitCode::bad_input) ||
                                               exit.code == static_cast<int>(core::ExitCode::environment));
        if (told) exit_code_ = static_cast<core::ExitCode>(exit.code);
        if (exit.code == 127) exit_code_ = core::ExitCode::environment;
    }

    static void remove_work(const results::DatasetOrder& order) {
        std::error_code ignored;
        std::filesystem::remove_all(
            order.output / fmt::format("work-{}-{}", order.scenario, order.replication), ignored);
    }

    const std::vector<results::DatasetOrder>& orders_;
    std::vector<std::filesystem::path> logs_;  ///< Of orders that did not fail; empty otherwise.
    std::string program_;
    std::vector<Worker> workers_;
    std::size_t next_ = 0;
    std::size_t done_ = 0;
    std::size_t failed_ = 0;
    core::ExitCode exit_code_ = core::ExitCode::ok;
};

}  // namespace

RecordResult record_orders(const std::vector<results::DatasetOrder>& orders, unsigned jobs) {
    const std::size_t places = jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
    const InterruptionWatch interruption;
    core::Progress progress("recordings", orders.size(), core::Progress::style_for_stderr());
    Recording recording(orders);
    while (interruption.received() == 0 && !(recording.all_started() && recording.running() == 0)) {
        while (!recording.all_started() && recording.running() < places) {
            recording.start_next();
        }
        std::this_thread::sleep_for(poll_interval);
        recording.collect();
        progress.update(recording.done(), recording.failed());
    }
    recording.end_all();
    progress.finish();
    core::ExitCode code = recording.exit_code();
    if (interruption.received() == SIGINT) code = core::ExitCode::interrupted;
    if (interruption.received() == SIGTERM) code = core::ExitCode::terminated;
    return {code, recording.lines()};
}

}  // namespace clearway::cli
