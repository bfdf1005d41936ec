#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/plan_text.hpp"
#include "cli/run_plan.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {
namespace {

enum class Mode : std::uint8_t { run, dry_run };

struct Arguments {
    std::string file;
    std::string folder;
    Mode mode = Mode::run;
    study::Extent extent = study::Extent::whole;
    unsigned jobs = 0;
    results::StepRecording recording = results::StepRecording::off;
    Printing printing = Printing::text;
};

core::ExitCode run_study(const Arguments& arguments, const Invocation& invocation) {
    const study::StudyConfig config = study::read_study(arguments.file, arguments.extent);
    const std::string folder = arguments.folder.empty() ? "runs/" + config.name : arguments.folder;
    RunPlanOptions options{folder, arguments.jobs, arguments.printing, invocation.command,
                           arguments.recording};
    const study::Plan plan = plan_for(config, options);
    if (arguments.mode == Mode::run) return run_and_print(plan, options);
    fmt::print("{}", arguments.printing == Printing::json ? plan_json(plan, options.folder, options.workers)
                                                          : plan_text(plan, options.folder, options.workers));
    return core::ExitCode::ok;
}

}  // namespace

Action configure_study(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("file", arguments->file, "Study file, TOML: scenarios, conditions, replications, seed")
        ->required()
        ->option_text("FILE (required)");
    app.add_option("--out", arguments->folder, "Run folder; a study that was interrupted there continues")
        ->option_text("DIR [runs/NAME, the name that the file gives]");
    app.add_flag_callback(
        "--dry-run", [arguments] { arguments->mode = Mode::dry_run; },
        "Print cells, runs and estimated time, and run nothing [off]");
    app.add_flag_callback(
        "--quick", [arguments] { arguments->extent = study::Extent::quick; },
        "Run what [quick] of the file leaves of the study, into runs/NAME-quick [the whole study]");
    add_jobs_option(app, arguments->jobs);
    add_record_option(app, arguments->recording);
    add_json_option(app, arguments->printing, "tables or plan");
    return [arguments](const Invocation& invocation) { return run_study(*arguments, invocation); };
}

}  // namespace clearway::cli
