#include "campaign/live.hpp"

#include <csignal>
#include <cstdio>
#include <optional>
#include <random>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "campaign/programs.hpp"
#include "campaign/shown_run.hpp"
#include "campaign/worker_jobs.hpp"
#include "core/counted.hpp"
#include "core/files.hpp"
#include "core/interruption.hpp"
#include "core/process.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/job.hpp"
#include "server/access.hpp"

namespace clearway::campaign {
namespace {

/// Folders of this verb: those that a killed process left go when the next one begins.
constexpr const char* work_prefix = "live-";
constexpr const char* socket_prefix = "clearway-live-";

/// 128 random bits, from the system.
std::string new_token() {
    std::random_device draw;
    std::string token;
    for (int i = 0; i < 4; ++i)
        token += fmt::format("{:08x}", draw());
    return token;
}

/// The processes that make the runs. Those that still run when it is destroyed are ended.
class LiveWorkers {
  public:
    ~LiveWorkers() { end(); }
    LiveWorkers() = default;
    LiveWorkers(const LiveWorkers&) = delete;
    LiveWorkers& operator=(const LiveWorkers&) = delete;

    void start(const experiment::RunJob& unit, const std::filesystem::path& work) {
        const std::filesystem::path file = work / "job.json";
        core::make_folder(work);
        core::write_atomically(file, experiment::to_json(unit));
        const std::filesystem::path log = work / "worker.log";
        workers_.push_back({core::start({.program = sister_program("clearway-run"),
                                         .arguments = {std::filesystem::absolute(file)},
                                         .output = log}),
                            unit.conditions.front().name, log});
    }
    /// Whether one has ended and was not well.
    bool has_failed() {
        bool failed = false;
        for (Worker& worker : workers_) {
            if (!worker.exit) worker.exit = core::poll(worker.child);
            failed = failed || (worker.exit && !worker.exit->ok());
        }
        return failed;
    }
    /// Ends those that still run: nobody allows them to go on.
    void end() {
        for (Worker& worker : workers_) {
            if (worker.exit) continue;
            ::kill(worker.child.pid, SIGTERM);
            worker.was_ended = true;
        }
        wait();
    }
    void wait() {
        for (Worker& worker : workers_) {
            if (!worker.exit) worker.exit = core::wait(worker.child);
        }
    }
    /// Says on standard error what failed, and returns the exit code.
    core::ExitCode report() const {
        core::ExitCode code = core::ExitCode::ok;
        for (const Worker& worker : workers_) {
            if (worker.exit->ok() || worker.was_ended) continue;
            fmt::print(stderr, "clearway: {}: {}\n{}", worker.condition, worker.exit->describe(),
                       core::tail(worker.log, shown_lines));
            code = exit_code_of(*worker.exit);
        }
        return code;
    }

  private:
    struct Worker {
        core::Child child;
        std::string condition;
        std::filesystem::path log;
        std::optional<core::Exit> exit = std::nullopt;
        bool was_ended = false;  ///< By this program.
    };
    std::vector<Worker> workers_;
};

/// The surest address is the first line of the output: a program that starts this one reads it.
void say_addresses(const server::LiveConfig& config, std::uint16_t port) {
    const std::vector<std::string> pages = server::pages_of(config.host, port, config.token);
    fmt::print("{}\n", pages.front());
    std::fflush(stdout);
    fmt::print(stderr, "clearway: open this address in a browser; {}\n",
               config.allow_control ? "anyone who has the address can pause the runs and set their speed"
                                    : "viewers can watch but not control the runs");
    for (std::size_t row = 1; row < pages.size(); ++row)
        fmt::print(stderr, "clearway: or {}\n", pages[row]);
}

/// Makes the runs while `server` shows them. Returns ok, or why they did not finish.
core::ExitCode show(const std::vector<experiment::RunJob>& units, server::LiveServer& server,
                    const std::filesystem::path& sockets, const server::LiveConfig& config) {
    const core::InterruptionWatch interruption;
    const core::TemporaryFolder work(core::process_folder(units.front().output / "work", work_prefix));
    LiveWorkers workers;
    std::size_t run = 0;
    for (experiment::RunJob unit : units) {
        unit.live = experiment::LiveSpec{server::socket_of(sockets, run++)};
        workers.start(unit, work.path() / unit.conditions.front().name);
    }
    say_addresses(config, server.port());
    server.run([&] { return interruption.signal() != 0 || workers.has_failed(); });
    const server::LiveCounts counts = server.counts();
    fmt::print(stderr, "clearway: {}, {} refused; {} sent, {} skipped for slow viewers\n",
               core::counted(counts.clients, "viewer"), counts.refused,
               core::counted(counts.frames_sent, "frame"), counts.frames_dropped);
    if (interruption.signal() != 0) return interruption.exit_code(core::ExitCode::ok);
    if (workers.has_failed()) workers.end();
    workers.wait();
    return workers.report();
}

}  // namespace

core::ExitCode run_live(LiveRequest request) {
    if (!server::is_loopback(request.server.host, "--host") && request.server.token.empty())
        request.server.token = new_token();
    const study::Plan plan = plan_for(request.config, request.run);
    std::vector<experiment::RunJob> units;
    request.server.title = plan.manifest.study + ":";
    for (const experiment::ConditionSpec& condition : request.watched) {
        units.push_back(unit_of(plan, condition));
        request.server.title += " " + condition.name;
    }
    request.server.runs = units.size();
    const core::TemporaryFolder sockets(core::process_folder(core::temporary_place(), socket_prefix));
    // Before the run folder: an address that cannot be served leaves none.
    server::LiveServer server(request.server, sockets.path());
    const results::Store store = prepare_run_folder(plan, request.run);
    const core::ExitCode code = show(units, server, sockets.path(), request.server);
    std::error_code ignored;
    std::filesystem::remove(store.folder() / "work", ignored);  // if it is empty
    return code == core::ExitCode::ok ? complete(plan, store, request.run) : code;
}

}  // namespace clearway::campaign
