#include "campaign/shown_run.hpp"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "campaign/worker_jobs.hpp"
#include "core/leftovers.hpp"

namespace clearway::campaign {
namespace {

bool is_set(const char* variable) {
    const char* const value = std::getenv(variable);
    return value != nullptr && !std::string_view(value).empty();
}

void require_display() {
    if (is_set("DISPLAY")) return;
    if (is_set("WAYLAND_DISPLAY"))
        throw core::EnvironmentError(
            "--gui needs an X display, and DISPLAY is not set: sumo-gui does not support Wayland. Install "
            "Xwayland (Debian package xwayland) and restart the session, or leave --gui out");
    throw core::EnvironmentError(
        "--gui needs a display, and DISPLAY is not set. Run it in a graphical session, over ssh with ssh "
        "-X, or leave --gui out");
}

/// Shows the run. Returns ok, or why it did not finish.
core::ExitCode show(const experiment::RunJob& unit) {
    const std::string label =
        experiment::to_text({unit.scenario, unit.conditions.front().name, unit.replication});
    const std::filesystem::path work = unit.output / "work" / fmt::format("window-{}", ::getpid());
    fmt::print(stderr, "clearway: {} in sumo-gui\n", label);
    const WorkerResult result = work_on({{.label = label,
                                          .job = unit,
                                          .file = work / "job.json",
                                          .log = work / "worker.log",
                                          .work = {work}}},
                                        1, "shown");
    std::error_code ignored;
    std::filesystem::remove_all(work, ignored);
    return result.exit_code;
}

}  // namespace

experiment::RunJob unit_of(const study::Plan& plan, const experiment::ConditionSpec& shown) {
    for (const study::PlannedUnit& planned : plan.units) {
        if (experiment::process_of(planned.unit.conditions.front()) != experiment::process_of(shown))
            continue;
        experiment::RunJob unit = planned.unit;
        unit.conditions = {shown};
        return unit;
    }
    throw std::logic_error("the shown condition is not in the plan");
}

core::ExitCode show_and_print(const study::Plan& plan, const RunOptions& options,
                              const experiment::ConditionSpec& shown, const experiment::WindowSpec& window) {
    require_display();
    // Removed below: nothing of the user's may be in it, hidden or not.
    const bool is_new = core::holds_only(options.folder, [](const std::string&) { return false; });
    const results::Store store = prepare_run_folder(plan, options);
    experiment::RunJob unit = unit_of(plan, shown);
    unit.window = window;
    const core::ExitCode code = show(unit);
    if (code != core::ExitCode::ok) {
        std::error_code ignored;
        if (is_new) std::filesystem::remove_all(options.folder, ignored);
        return code;
    }
    return complete(plan, store, options);
}

}  // namespace clearway::campaign
