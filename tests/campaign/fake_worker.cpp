// Does as clearway-run is asked to, without a simulator. What becomes of a run depends on the start of its
// condition's name.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/error.hpp"
#include "experiment/job.hpp"
#include "results/store.hpp"
#include "results/synthetic.hpp"

namespace {

using namespace clearway;

void pause_ms(int duration) {
    std::this_thread::sleep_for(std::chrono::milliseconds(duration));
}

/// True the first time that it is called for a run.
bool first_time(const results::Store& store, const experiment::RunKey& key) {
    const auto marker =
        store.folder() / ("." + key.scenario + key.condition + std::to_string(key.replication));
    if (std::filesystem::exists(marker)) return false;
    std::ofstream(marker) << "x";
    return true;
}

void tell(const results::Store& store, const experiment::RunKey& key, results::ErrorCause cause,
          const std::string& message) {
    results::RunError failure;
    failure.key = key;
    failure.cause = cause;
    failure.message = message;
    failure.command = "clearway-run it";
    store.write(failure);
}

/// Holds 200 MiB of memory that is really used.
void hog(int duration_ms) {
    const std::vector<char> memory(std::size_t{200} << 20, 'x');
    pause_ms(duration_ms);
    std::printf("%c", memory.back());
}

/// Dies as a program does that no sanitizer watches.
void crash() {
    std::signal(SIGSEGV, SIG_DFL);
    std::raise(SIGSEGV);
}

/// Ends the process where the condition says so; true when a record was written.
void work(const results::Store& store, const experiment::RunKey& key) {
    const std::string& name = key.condition;
    std::printf("run %s\n", experiment::to_text(key).c_str());
    std::fflush(stdout);
    if (name.starts_with("crash_once") && first_time(store, key)) crash();
    if (name == "crash") crash();
    if (name == "hang") pause_ms(600000);
    if (name == "bad_input") {
        std::fprintf(stderr, "clearway-run: its file: no number.\nNor another.\n");
        std::exit(3);
    }
    if (name == "disk_full") std::exit(4);
    if (name == "forgetful") return;
    if (name == "refused") return tell(store, key, results::ErrorCause::simulator, "SUMO said no");
    if (name == "told_crash") return tell(store, key, results::ErrorCause::signal, "child was killed");
    if (name == "told_memory") return tell(store, key, results::ErrorCause::memory, "too much");
    if (name == "hog") hog(600000);
    if (name == "large") hog(500);
    if (name.starts_with("slow")) pause_ms(40);
    results::synthetic::write(store, results::synthetic::record(key, 40.0 + key.replication));
}

}  // namespace

int main(int, char** arguments) {
    try {
        const auto unit = std::get<experiment::RunJob>(experiment::read_job(arguments[1]));
        const results::Store store = results::Store::open(unit.output);
        for (const experiment::ConditionSpec& condition : unit.conditions)
            work(store, {unit.scenario, condition.name, unit.replication});
        return 0;
    } catch (const core::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return static_cast<int>(error.exit_code());
    }
}
