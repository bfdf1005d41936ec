#include "cli/worker_orders.hpp"

#include <algorithm>
#include <array>
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

/// The worker processes.
class Workers {
  public:
    explicit Workers(const std::vector<WorkerOrder>& orders)
        : orders_(orders), logs_(orders.size()), program_(sister_program("clearway-run")) {}

    bool all_started() const { return next_ == orders_.size(); }
    std::size_t running() const { return workers_.size(); }
    std::size_t done() const { return done_; }
    std::size_t failed() const { return failed_; }
    core::ExitCode exit_code() const { return exit_code_; }

    void start_next() {
        const WorkerOrder& order = orders_[next_];
        core::make_folder(order.file.parent_path());
        logs_[next_] = order.log;
        core::write_atomically(order.file, order.text);
        workers_.push_back({next_, core::start({.program = program_,
                                                .arguments = {order.option, order.file.string()},
                                                .output = order.log})});
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
        const WorkerOrder& order = orders_[worker.order];
        const std::string words = core::tail(order.log, shown_lines);
        remove_work(order);
        const bool is_kept = std::filesystem::exists(order.log);
        fmt::print(stderr, "\nclearway: {}: {}{}\n{}", order.label, exit.describe(),
                   is_kept ? fmt::format(" ({})", order.log.string()) : "", words);
        logs_[worker.order].clear();
        if (exit_code_ != core::ExitCode::ok) return;
        exit_code_ = core::ExitCode::runs_failed;
        const auto code = static_cast<core::ExitCode>(exit.code);
        constexpr std::array told = {core::ExitCode::bad_input, core::ExitCode::environment,
                                     core::ExitCode::incomplete, core::ExitCode::conflict};
        if (exit.signal == 0 && std::ranges::find(told, code) != told.end()) exit_code_ = code;
        if (exit.code == 127) exit_code_ = core::ExitCode::environment;
    }

    static void remove_work(const WorkerOrder& order) {
        std::error_code ignored;
        std::filesystem::remove_all(order.work, ignored);
    }

    const std::vector<WorkerOrder>& orders_;
    std::vector<std::filesystem::path> logs_;  ///< Of orders that did not fail; empty otherwise.
    std::string program_;
    std::vector<Worker> workers_;
    std::size_t next_ = 0;
    std::size_t done_ = 0;
    std::size_t failed_ = 0;
    core::ExitCode exit_code_ = core::ExitCode::ok;
};

}  // namespace

WorkerResult work_on(const std::vector<WorkerOrder>& orders, unsigned jobs, const std::string& title) {
    const std::size_t places = jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
    const InterruptionWatch interruption;
    core::Progress progress(title, orders.size(), core::Progress::style_for_stderr());
    Workers workers(orders);
    while (interruption.received() == 0 && !(workers.all_started() && workers.running() == 0)) {
        while (!workers.all_started() && workers.running() < places) {
            workers.start_next();
        }
        std::this_thread::sleep_for(poll_interval);
        workers.collect();
        progress.update(workers.done(), workers.failed());
    }
    workers.end_all();
    progress.finish();
    core::ExitCode code = workers.exit_code();
    if (interruption.received() == SIGINT) code = core::ExitCode::interrupted;
    if (interruption.received() == SIGTERM) code = core::ExitCode::terminated;
    return {code, workers.lines()};
}

}  // namespace clearway::cli
