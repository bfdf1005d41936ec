#include "loop/worker.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/process.hpp"
#include "loop/unit_run.hpp"

namespace clearway::loop {
namespace {

/// Lines of SUMO's own log that go into a failure record.
constexpr int log_lines = 30;

struct Places {
    std::filesystem::path demand;
    std::filesystem::path work;
};

results::RunKey key_of(const results::UnitSpec& unit, const results::ConditionSpec& condition) {
    return {unit.scenario, condition.name, unit.replication};
}

void store_failure(const results::Store& store, const results::RunKey& key, const core::Error& error,
                   const std::filesystem::path& folder) {
    results::FailureRecord failure;
    failure.key = key;
    failure.cause = error.exit_code() == core::ExitCode::bad_input ? results::FailureCause::bad_input
                                                                   : results::FailureCause::simulator;
    failure.message = error.what();
    failure.exit_code = static_cast<int>(error.exit_code());
    failure.log_tail = core::tail(folder / "sumo.log", log_lines);
    store.write(failure);
}

/// The forked child's whole life. Never returns: the parent's objects must not be destroyed twice.
[[noreturn]] void be_condition(UnitRun& run, const results::Store& store, const results::RunKey& key,
                               const results::ConditionSpec& condition, const std::filesystem::path& folder) {
    core::ExitCode code = core::ExitCode::ok;
    try {
        core::make_folder(folder);
        results::RunTiming timing;
        const results::RunRecord record = run.finish_in(folder, condition, timing);
        store.write(record, timing);
        std::filesystem::remove_all(folder);
    } catch (const core::Error& error) {
        fmt::print(stderr, "{}: {}\n", results::to_text(key), error.what());
        code = error.exit_code();
        if (code == core::ExitCode::runs_failed || code == core::ExitCode::bad_input) {
            store_failure(store, key, error, folder);
            code = core::ExitCode::ok;
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", results::to_text(key), error.what());
        std::fflush(nullptr);
        std::abort();  // our own fault: leave a signal behind, as an assertion would
    }
    std::fflush(nullptr);
    _exit(static_cast<int>(code));
}

/// Wait status of the child that ran the condition.
int fork_condition(UnitRun& run, const results::Store& store, const results::RunKey& key,
                   const results::ConditionSpec& condition, const std::filesystem::path& folder) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) throw core::EnvironmentError(fmt::format("cannot fork for {}", results::to_text(key)));
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        be_condition(run, store, key, condition, folder);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR)
            throw core::EnvironmentError(fmt::format("cannot wait for {}", results::to_text(key)));
    }
    return status;
}

Places places_of(const results::UnitSpec& unit, const results::Store& store,
                 const std::filesystem::path& unit_file) {
    const std::string replication = std::to_string(unit.replication);
    Places places{.demand = store.scenario_folder(unit.scenario) / "demand" / replication,
                  .work = store.folder() / "work" / unit_file.stem()};
    core::make_folder(places.demand);
    core::make_folder(places.work);
    return places;
}

/// Ends this process as its child ended, so that the study sees the signal.
[[noreturn]] void die_by(int signal) {
    std::fflush(nullptr);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    std::abort();
}

}  // namespace

core::ExitCode run_unit(const std::filesystem::path& unit_file) {
    const results::UnitSpec unit = results::read_unit(unit_file);
    const results::Store store = results::Store::open(unit.output);
    const Places places = places_of(unit, store, unit_file);
    std::optional<UnitRun> run;
    try {
        run.emplace(unit, places.demand, places.work);
    } catch (const core::SimulatorError& error) {
        for (const results::ConditionSpec& condition : unit.conditions) {
            store_failure(store, key_of(unit, condition), error, places.work);
        }
        return core::ExitCode::ok;
    }
    int signal = 0;
    for (const results::ConditionSpec& condition : unit.conditions) {
        const results::RunKey key = key_of(unit, condition);
        if (store.done(unit, condition)) continue;
        const int status = fork_condition(*run, store, key, condition, places.work / condition.name);
        if (WIFSIGNALED(status)) signal = WTERMSIG(status);
        if (WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(core::ExitCode::environment)) {
            return core::ExitCode::environment;
        }
    }
    if (signal != 0) die_by(signal);
    run.reset();
    std::filesystem::remove_all(places.work);
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
