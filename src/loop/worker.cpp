#include "loop/worker.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/machine_failure.hpp"
#include "core/process.hpp"
#include "core/program.hpp"
#include "core/read_failure.hpp"
#include "experiment/job.hpp"
#include "loop/jobs.hpp"
#include "loop/unit_run.hpp"
#include "loop/watch.hpp"
#include "python/channel.hpp"

namespace clearway::loop {
namespace {

/// Lines of SUMO's log that go into an error record.
constexpr int log_lines = 30;

struct Places {
    std::filesystem::path demand;
    std::filesystem::path work;
};

experiment::RunKey key_of(const experiment::RunJob& unit, const experiment::ConditionSpec& condition) {
    return {unit.scenario, condition.name, unit.replication};
}

/// What the errors of one unit have in common.
struct Unit {
    const experiment::RunJob& spec;
    const results::Store& store;
    std::filesystem::path file;
};

results::RunError error_of(const Unit& unit, const experiment::RunKey& key,
                           const std::filesystem::path& folder) {
    results::RunError error;
    error.key = key;
    error.log_tail = core::tail(folder / "sumo.log", log_lines);
    error.command = core::shell_text({core::program_folder() / "clearway-run", unit.file});
    return error;
}

void store_error(const Unit& unit, const experiment::RunKey& key, const core::Error& cause,
                 const std::filesystem::path& folder) {
    results::RunError error = error_of(unit, key, folder);
    const bool is_python = dynamic_cast<const python::PartError*>(&cause) != nullptr;
    const auto* const lost = dynamic_cast<const python::PartLost*>(&cause);
    error.cause = is_python                                        ? results::ErrorCause::python
                  : lost != nullptr && lost->signal() != 0         ? results::ErrorCause::signal
                  : lost != nullptr                                ? results::ErrorCause::machine
                  : cause.exit_code() == core::ExitCode::bad_input ? results::ErrorCause::bad_input
                                                                   : results::ErrorCause::simulator;
    if (lost != nullptr) error.signal = lost->signal();
    error.message = cause.what();
    error.exit_code = static_cast<int>(cause.exit_code());
    unit.store.write(error);
}

/// Throws core::EnvironmentError on a full disk, which makes SUMO fail in many ways for which no run is to
/// blame.
void require_space(const std::filesystem::path& folder) {
    const std::filesystem::path probe = folder / "probe";
    core::write_atomically(probe, std::string(std::size_t{1} << 18, ' '));
    std::filesystem::remove(probe);
}

/// Records the error of a process that could not do it itself.
void store_error(const Unit& unit, const experiment::RunKey& key, const WatchedEnd& end,
                 const std::filesystem::path& folder) {
    results::RunError error = error_of(unit, key, folder);
    error.signal = WTERMSIG(end.status);
    if (end.by == core::EndedBy::time_limit) {
        error.cause = results::ErrorCause::time_limit;
        error.message = fmt::format("did not end within {:g} s", unit.spec.limits.wall_s);
    } else if (end.by == core::EndedBy::memory_limit) {
        error.cause = results::ErrorCause::memory;
        error.message = fmt::format("needed more than {} MiB", unit.spec.limits.memory_mib);
    } else {
        error.cause = results::ErrorCause::signal;
        error.message = core::Exit{.signal = error.signal}.describe();
    }
    unit.store.write(error);
}

/// Returns ok, or environment when the disk is full or the error cannot be stored.
core::ExitCode try_to_store_error(const Unit& unit, const experiment::RunKey& key, const core::Error& cause,
                                  const std::filesystem::path& folder) {
    try {
        require_space(folder);
        store_error(unit, key, cause, folder);
        return core::ExitCode::ok;
    } catch (const core::EnvironmentError& environment) {
        core::complain(experiment::to_text(key), environment);
    } catch (const std::system_error& error) {
        core::complain(experiment::to_text(key), error);
    }
    return core::ExitCode::environment;
}

/// Everything the forked child does. Never returns, because the parent's objects must not be destroyed twice.
[[noreturn]] void be_condition(UnitRun& run, const Unit& unit, const experiment::ConditionSpec& condition,
                               const std::filesystem::path& folder) {
    const experiment::RunKey key = key_of(unit.spec, condition);
    core::ExitCode code = core::ExitCode::ok;
    try {
        core::make_folder(folder);
        results::RunTiming timing;
        const results::RunRecord record = run.finish_in(folder, condition, timing);
        unit.store.write(record, timing);
        std::filesystem::remove_all(folder);
    } catch (const core::Error& error) {
        core::complain(experiment::to_text(key), error);
        code = error.exit_code();
        if (code == core::ExitCode::runs_failed || code == core::ExitCode::bad_input)
            code = try_to_store_error(unit, key, error, folder);
    } catch (const std::bad_alloc&) {
        core::complain(experiment::to_text(key), core::no_memory());
        code = core::ExitCode::environment;
    } catch (const std::system_error& error) {
        core::complain(experiment::to_text(key), core::error_of(error));
        code = core::ExitCode::environment;
    } catch (const std::exception& error) {
        core::complain(experiment::to_text(key), error);
        std::fflush(nullptr);
        std::abort();  // a bug of ours: die by a signal, as an assertion would
    }
    std::fflush(nullptr);
    _exit(static_cast<int>(code));
}

/// Ends this process by a signal that `ChildSignals` blocks.
void end_by(int signal) {
    ChildSignals::release();
    std::raise(signal);
}

/// Runs a condition in its own child. Returns the child's exit code, or ok when an error was recorded.
core::ExitCode fork_condition(UnitRun& run, const Unit& unit, const experiment::ConditionSpec& condition,
                              const std::filesystem::path& folder) {
    const experiment::RunKey key = key_of(unit.spec, condition);
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
        throw core::EnvironmentError(fmt::format("{}: cannot fork: {}. {}", experiment::to_text(key),
                                                 std::strerror(errno), core::cure_of(errno)));
    if (child == 0) {
        ChildSignals::release();
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        be_condition(run, unit, condition, folder);
    }
    const WatchedEnd end = watch(child, unit.spec.limits);
    if (end.interruption != 0) end_by(end.interruption);
    if (WIFEXITED(end.status)) return static_cast<core::ExitCode>(WEXITSTATUS(end.status));
    const int signal = WTERMSIG(end.status);
    if (signal == SIGINT || signal == SIGTERM) end_by(signal);  // an interruption, not an error
    store_error(unit, key, end, folder);
    return core::ExitCode::ok;
}

Places places_of(const experiment::RunJob& unit, const results::Store& store,
                 const std::filesystem::path& unit_file) {
    const std::string replication = std::to_string(unit.replication);
    Places places{.demand = store.scenario_folder(unit.scenario) / "demand" / replication,
                  .work = store.work_folder(unit_file.stem().string())};
    core::make_folder(places.demand);
    core::make_folder(places.work);
    return places;
}

/// Loads SUMO once, warms up once, and forks one child per condition that has no record yet; each child
/// stores its run. A child that fails leaves an error record with the cause, even when it was killed by a
/// signal or for exceeding a limit of the job, and the others continue.
core::ExitCode run_unit(const experiment::RunJob& unit, const std::filesystem::path& unit_file) {
    const results::Store store = results::Store::open(unit.output);
    const Places places = places_of(unit, store, unit_file);
    const Unit shared{unit, store, std::filesystem::absolute(unit_file)};
    std::vector<experiment::RunKey> keys;
    for (const experiment::ConditionSpec& condition : unit.conditions)
        keys.push_back(key_of(unit, condition));
    std::optional<UnitRun> run;
    try {
        run.emplace(unit, places.demand, places.work);
    } catch (const core::SimulatorError& error) {
        require_space(places.work);
        for (const experiment::RunKey& key : keys)
            store_error(shared, key, error, places.work);
        return core::ExitCode::ok;
    }
    const ChildSignals signals;
    for (const experiment::ConditionSpec& condition : unit.conditions) {
        if (store.done(unit, condition)) continue;
        const core::ExitCode code = fork_condition(*run, shared, condition, places.work / condition.name);
        if (code != core::ExitCode::ok) return code;
    }
    run.reset();
    const auto is_complete = [&](const experiment::RunKey& key) { return store.complete(key); };
    if (std::ranges::all_of(keys, is_complete)) std::filesystem::remove_all(places.work);
    store.flush(keys);
    return core::ExitCode::ok;
}

/// Does each kind of job.
struct Work {
    std::filesystem::path file;  ///< Of the job.

    core::ExitCode operator()(const experiment::RunJob& job) const {
        if (job.live) return run_live(job, std::filesystem::absolute(file).parent_path());
        return job.window ? run_shown(job, std::filesystem::absolute(file).parent_path())
                          : run_unit(job, file);
    }
    core::ExitCode operator()(const experiment::DatasetJob& job) const { return record_dataset(job); }
    core::ExitCode operator()(const experiment::LinkJob& job) const { return evaluate_links(job); }
    core::ExitCode operator()(const experiment::AttachJob& job) const { return run_attached(job); }
};

}  // namespace

core::ExitCode work_on(const std::filesystem::path& job_file) {
    return std::visit(Work{job_file}, experiment::read_job(job_file));
}

}  // namespace clearway::loop
