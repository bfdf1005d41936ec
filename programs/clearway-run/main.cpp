#include <cstdio>
#include <cstdlib>
#include <new>
#include <string_view>

#include <fmt/format.h>

#include "core/build_stamp.hpp"
#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "core/process.hpp"
#include "loop/episodes.hpp"
#include "loop/worker.hpp"
#include "sumo/session.hpp"

namespace {

constexpr const char* usage =
    "clearway-run, the worker of clearway; it is started by clearway, not by hand.\n"
    "  clearway-run JOB.json    do the job in a file: runs, a data set, links to evaluate, or a simulation\n"
    "                           that runs elsewhere\n"
    "  clearway-run --episodes JOB.json MEMORY READ WRITE\n"
    "                           serve episodes to an environment in Python, over these descriptors\n"
    "  clearway-run --version\n";

int fail_usage() {
    fmt::print(stderr, "{}", usage);
    return static_cast<int>(clearway::core::ExitCode::usage);
}

}  // namespace

int main(int argument_count, char** arguments) {
    namespace core = clearway::core;
    core::begin_program();
    const std::string_view word = argument_count == 2 ? arguments[1] : "";
    try {
        if (word == "--version") {
            fmt::print("clearway-run {} with SUMO {}\nbuild {}\n", CLEARWAY_VERSION,
                       clearway::sumo::version(), core::build_stamp());
            return 0;
        }
        if (argument_count == 6 && std::string_view(arguments[1]) == "--episodes")
            return static_cast<int>(clearway::loop::serve_episodes(
                arguments[2], {std::atoi(arguments[3]), std::atoi(arguments[4]), std::atoi(arguments[5])}));
        if (word.empty() || word.starts_with('-')) return fail_usage();
        return static_cast<int>(clearway::loop::work_on(word));
    } catch (const core::Error& error) {
        fmt::print(stderr, "clearway-run: {}\n", error.what());
        return static_cast<int>(error.exit_code());
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "clearway-run: {}\n", core::no_memory().what());
        return static_cast<int>(core::ExitCode::environment);
    }
}
