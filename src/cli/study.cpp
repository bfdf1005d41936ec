#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "campaign/plan_text.hpp"
#include "campaign/study_run.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/verb.hpp"
#include "core/interruption.hpp"
#include "study/plan.hpp"
#include "study/shard.hpp"

namespace clearway::cli {
namespace {

struct StudyArguments {
    std::string file;
    std::vector<std::string> scenarios;
    std::string shard;
    std::vector<std::string> models;
    Mode mode = Mode::run;
    study::Extent extent = study::Extent::whole;
    std::uint32_t baselines = 0;  ///< Replications of the baselines alone; 0: the whole study.
    std::uint64_t most_runs = results::usual_most_runs;
    campaign::RunOptions run;
};

core::ExitCode run_study(const StudyArguments& arguments, const Invocation& invocation) {
    const core::InterruptionNotice notice(campaign::interrupted_between_runs(invocation.command));
    study::Shard shard;
    if (!arguments.shard.empty()) shard = study::shard_from(arguments.shard, "--shard");
    study::StudyConfig config =
        study::read_study(arguments.file, arguments.extent, arguments.most_runs, arguments.scenarios);
    apply_models(arguments.models, config.conditions);
    if (arguments.baselines > 0) config = study::baselines_of(std::move(config), arguments.baselines);
    campaign::RunOptions run = arguments.run;
    run.command = invocation.command;
    if (run.folder.empty()) run.folder = "runs/" + config.name;
    campaign::check_seed(config, arguments.file, run.folder);
    if (arguments.mode == Mode::dry_run) return campaign::print_plan(config, shard, run);
    if (!shard.whole()) return campaign::run_shard(config, shard, run);
    study::claim(run.folder, shard);
    return campaign::run_study(config, run);
}

}  // namespace

Action configure_study(App& app) {
    const auto arguments = std::make_shared<StudyArguments>();
    app.add_option("file", arguments->file, "Study file, TOML: scenarios, conditions, factors, replications")
        .required()
        .option_text("FILE (required)");
    const Option out = app.add_option("--out", arguments->run.folder,
                                      "Run folder; a study that was interrupted there is "
                                      "continued")
                           .option_text("DIR [runs/NAME, with the name in the file]");
    app.add_option("--scenario", arguments->scenarios,
                   "Scenario in place of those of the file, into runs/NAME-SCENARIO; can be repeated")
        .option_text("SCENARIO ... [those of the file]");
    app.add_option(
           "--reuse", arguments->run.reused,
           "Run folder whose runs are taken over where scenario, seed and condition, whatever its name, "
           "are the same, as after a change of another condition")
        .option_text("DIR [none]");
    app.add_option("--shard", arguments->shard,
                   "Run only the I-th of N shards, into --out; `clearway study merge` merges them")
        .option_text("I/N [the whole]")
        .needs(out);
    app.add_option("--model", arguments->models,
                   "Net for the conditions whose predictor it is of; can be repeated")
        .option_text("[PREDICTOR=]FILE ... [as the study file says]");
    app.add_flag_callback(
        "--dry-run", [arguments] { arguments->mode = Mode::dry_run; },
        "Print cells, runs, estimated time and disk, and run nothing [off]");
    app.add_flag_callback(
        "--quick", [arguments] { arguments->extent = study::Extent::quick; },
        "Run what the file's [quick] leaves, into runs/NAME-quick [the whole study]");
    app.add_option("--baselines", arguments->baselines,
                   "Run only the baselines, N replications of each, into runs/NAME-baselines, for compare "
                   "--baselines")
        .range(std::uint32_t{1}, std::uint32_t{100000})
        .option_text("N, 1 to 100000 [the study]");
    add_most_runs_option(app, arguments->most_runs);
    add_jobs_option(app, arguments->run.workers);
    add_record_option(app, arguments->run.recording);
    add_limit_options(app, arguments->run.limits);
    add_retry_option(app, arguments->run.retried);
    add_json_option(app, arguments->run.publish.printing, "tables or plan");
    add_tables_option(app, arguments->run.publish.tables);
    add_response_option(app, arguments->run.publish.response_threshold_s);
    return [arguments](const Invocation& invocation) { return run_study(*arguments, invocation); };
}

}  // namespace clearway::cli
