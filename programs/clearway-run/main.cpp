#include <cstdio>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "loop/attached_run.hpp"
#include "loop/dataset.hpp"
#include "loop/evaluate_links.hpp"
#include "loop/shown_run.hpp"
#include "loop/worker.hpp"
#include "sumo/session.hpp"

namespace {

constexpr const char* usage =
    "clearway-run, the worker of clearway; it is started by clearway, not by hand.\n"
    "  clearway-run --unit FILE      run the conditions of a unit file\n"
    "  clearway-run --dataset FILE   record a data set as a dataset file says\n"
    "  clearway-run --links FILE     judge predictors as a links file says\n"
    "  clearway-run --attach FILE    go on with a simulation that runs elsewhere, as an attach file says\n"
    "  clearway-run --show FILE      run the one condition of a unit file in a window\n"
    "  clearway-run --version\n";

int fail_usage() {
    fmt::print(stderr, "{}", usage);
    return static_cast<int>(clearway::core::ExitCode::usage);
}

}  // namespace

int main(int argument_count, char** arguments) {
    namespace core = clearway::core;
    namespace loop = clearway::loop;
    const std::string_view order = argument_count > 1 ? arguments[1] : "";
    try {
        if (order == "--version") {
            fmt::print("clearway-run {} with SUMO {}\n", CLEARWAY_VERSION, clearway::sumo::version());
            return 0;
        }
        if (argument_count != 3) return fail_usage();
        if (order == "--unit") return static_cast<int>(loop::run_unit(arguments[2]));
        if (order == "--dataset") return static_cast<int>(loop::record_dataset(arguments[2]));
        if (order == "--links") return static_cast<int>(loop::evaluate_links(arguments[2]));
        if (order == "--show") return static_cast<int>(loop::run_shown(arguments[2]));
        if (order == "--attach") return static_cast<int>(loop::run_attached(arguments[2]));
        return fail_usage();
    } catch (const core::Error& error) {
        fmt::print(stderr, "clearway-run: {}\n", error.what());
        return static_cast<int>(error.exit_code());
    }
}
