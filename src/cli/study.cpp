#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "campaign/plan_text.hpp"
#include "campaign/rounds.hpp"
#include "campaign/run_plan.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/verb.hpp"
#include "study/shard.hpp"

namespace clearway::cli {
namespace {

enum class Mode : std::uint8_t { run, dry_run };

struct Arguments {
    std::string file;
    std::string folder;
    std::string shard;
    std::vector<std::string> models;
    Mode mode = Mode::run;
    study::Extent extent = study::Extent::whole;
    unsigned jobs = 0;
    experiment::StepRecording recording = experiment::StepRecording::off;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    std::optional<double> response_threshold_s;
};

void print_shard(const study::Shard& shard, const study::StudyProgress& progress, const std::string& folder,
                 Printing printing) {
    if (printing == Printing::json) {
        const nlohmann::ordered_json object = {{"shard", study::to_text(shard)},
                                               {"folder", folder},
                                               {"runs", progress.total},
                                               {"complete_runs", progress.done},
                                               {"failed_runs", progress.failed}};
        fmt::print("{}\n", object.dump(2));
    } else {
        fmt::print("shard {}: {} of {} runs complete, {} failed, in {}\n", study::to_text(shard),
                   progress.done, progress.total, progress.failed, folder);
    }
}

core::ExitCode run_shard(const study::StudyConfig& config, const study::Shard& shard,
                         campaign::RunPlanOptions options) {
    if (config.precision)
        throw core::InputError({"--shard",
                                "the study has a precision target, which needs all its runs at once",
                                "a study with replications",
                                "Run it as a whole, or give the number of replications that it reached"});
    study::Plan plan = campaign::plan_for(config, options);
    study::keep_shard(plan, shard);
    study::claim(options.folder, shard);
    const results::Store store = campaign::prepare_run_folder(plan, options);
    const study::StudyResult result = campaign::run_missing(plan, store, options);
    if (!campaign::was_interrupted(result))
        print_shard(shard, result.progress, options.folder.string(), options.printing);
    return result.exit_code;
}

core::ExitCode print_plan(study::StudyConfig config, const study::Shard& shard,
                          campaign::RunPlanOptions options) {
    config.replications = campaign::replications_so_far(config, options.folder);
    study::Plan plan = campaign::plan_for(config, options);
    study::check_roads(plan);
    study::keep_shard(plan, shard);
    fmt::print("{}", options.printing == Printing::json
                         ? campaign::plan_json(plan, options.folder, options.workers)
                         : campaign::plan_text(plan, options.folder, options.workers));
    return core::ExitCode::ok;
}

core::ExitCode run_study(const Arguments& arguments, const Invocation& invocation) {
    study::Shard shard;
    if (!arguments.shard.empty()) shard = study::shard_from(arguments.shard, "--shard");
    study::StudyConfig config = study::read_study(arguments.file, arguments.extent);
    apply_models(arguments.models, config.conditions);
    const std::string folder = arguments.folder.empty() ? "runs/" + config.name : arguments.folder;
    campaign::check_seed(config, arguments.file, folder);
    campaign::RunPlanOptions options{folder,
                                     arguments.jobs,
                                     arguments.limits,
                                     arguments.printing,
                                     invocation.command,
                                     arguments.recording,
                                     arguments.tables,
                                     arguments.response_threshold_s};
    if (arguments.mode == Mode::dry_run) return print_plan(config, shard, options);
    if (!shard.whole()) return run_shard(config, shard, options);
    study::claim(folder, shard);
    if (config.precision) return campaign::run_in_rounds(config, options);
    return campaign::run_and_print(campaign::plan_for(config, options), options);
}

}  // namespace

Action configure_study(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("file", arguments->file, "Study file, TOML: scenarios, conditions, factors, replications")
        ->required()
        ->option_text("FILE (required)");
    CLI::Option* const out = app.add_option("--out", arguments->folder,
                                            "Run folder; a study that was interrupted there is "
                                            "continued")
                                 ->option_text("DIR [runs/NAME, with the name in the file]");
    app.add_option("--shard", arguments->shard,
                   "Run only the I-th of N shards, into --out; `clearway merge` merges them")
        ->option_text("I/N [the whole]")
        ->needs(out);
    app.add_option("--model", arguments->models,
                   "Net for the conditions whose predictor it is of; can be repeated")
        ->option_text("[PREDICTOR=]FILE ... [as the study file says]");
    app.add_flag_callback(
        "--dry-run", [arguments] { arguments->mode = Mode::dry_run; },
        "Print cells, runs, estimated time and disk, and run nothing [off]");
    app.add_flag_callback(
        "--quick", [arguments] { arguments->extent = study::Extent::quick; },
        "Run what the file's [quick] leaves, into runs/NAME-quick [the whole study]");
    add_jobs_option(app, arguments->jobs);
    add_record_option(app, arguments->recording);
    add_limit_options(app, arguments->limits);
    add_json_option(app, arguments->printing, "tables or plan");
    add_tables_option(app, arguments->tables);
    add_response_option(app, arguments->response_threshold_s);
    return [arguments](const Invocation& invocation) { return run_study(*arguments, invocation); };
}

}  // namespace clearway::cli
