#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/build_stamp.hpp"
#include "core/error.hpp"
#include "core/fork_server.hpp"
#include "core/process.hpp"
#include "core/program.hpp"
#include "loop/episodes.hpp"
#include "loop/worker.hpp"
#include "sumo/session.hpp"

namespace {

constexpr const char* usage =
    "clearway-run, the worker of clearway; it is started by clearway, not by hand.\n"
    "  clearway-run JOB.json    do the job in a file: runs, a data set, links to evaluate, or a simulation\n"
    "                           that runs elsewhere\n"
    "  clearway-run --episodes JOB.json WAYS MEMORY READ WRITE\n"
    "                           serve episodes to an environment in Python, which is offered so many ways,\n"
    "                           over these descriptors\n"
    "  clearway-run --serve CHANNEL CLIENT\n"
    "                           fork a child of this process for each job whose file is named over this\n"
    "                           descriptor\n"
    "  clearway-run --version\n";

clearway::core::ExitCode fail_usage() {
    std::fputs(usage, stderr);
    return clearway::core::ExitCode::usage;
}

}  // namespace

int main(int argument_count, char** arguments) {
    namespace core = clearway::core;
    core::begin_program();
    // A bug fails the runs of this unit, and the study goes on.
    const auto ends = [](const auto& act) {
        return static_cast<int>(core::end_of("clearway-run", act, core::ExitCode::runs_failed));
    };
    const std::string_view word = argument_count == 2 ? arguments[1] : "";
    const auto act = [&] {
        if (word == "--version") {
            fmt::print("clearway-run {} with SUMO {}\nbuild {}\n", CLEARWAY_VERSION,
                       clearway::sumo::version(), core::build_stamp());
            return core::ExitCode::ok;
        }
        if (argument_count == 7 && std::string_view(arguments[1]) == "--episodes")
            return clearway::loop::serve_episodes(
                arguments[2], {std::atoi(arguments[4]), std::atoi(arguments[5]), std::atoi(arguments[6])},
                static_cast<std::uint32_t>(std::atoi(arguments[3])));
        if (argument_count == 4 && std::string_view(arguments[1]) == core::serve_option) {
            core::serve_forks(std::atoi(arguments[2]), std::atoi(arguments[3]), [&](const std::string& file) {
                return ends([&] { return clearway::loop::work_on(file); });
            });
            return core::ExitCode::ok;
        }
        if (word.empty() || word.starts_with('-')) return fail_usage();
        return clearway::loop::work_on(word);
    };
    return ends(act);
}
