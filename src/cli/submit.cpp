#include "campaign/submit.hpp"

#include <memory>
#include <string>
#include <vector>

#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

Action configure_submit(App& app) {
    struct SubmitArguments {
        campaign::SubmitRequest request;
        std::vector<std::string> models;
        std::uint64_t most_runs = results::usual_most_runs;
    };
    const auto arguments = std::make_shared<SubmitArguments>();
    campaign::SubmitRequest& request = arguments->request;
    app.add_option("file", request.file, "Study file").required().option_text("FILE (required)");
    app.add_option("--out", request.out, "Folder on a file system that all machines share")
        .required()
        .option_text("DIR (required)");
    app.add_choice("--engine", request.engine,
                   {{"slurm", study::SubmitEngine::slurm},
                    {"parallel", study::SubmitEngine::parallel},
                    {"local", study::SubmitEngine::local}},
                   "What runs the shards")
        .option_text("slurm|parallel|local [local]");
    app.add_option("--shards", request.shards, "Number of shards; 0: about five minutes of work each")
        .range(0U, 1000000U)
        .option_text("N, 0 to 1000000 [0]");
    app.add_option("--model", arguments->models,
                   "Net for the conditions whose predictor it is of, as study takes it; on the shared file "
                   "system; can be repeated")
        .option_text("[PREDICTOR=]FILE ... [as the study file says]");
    app.add_flag_callback(
        "--go", [&request] { request.start = campaign::SubmitRequest::Start::go; },
        "Also run submit.sh [only write it]");
    add_most_runs_option(app, arguments->most_runs);
    add_limit_options(app, request.limits);
    add_json_option(app, request.printing, "what was written");
    return [arguments](const Invocation& invocation) {
        arguments->request.command = invocation.command;
        const study::StudyConfig in_file =
            study::read_study(arguments->request.file, study::Extent::whole, arguments->most_runs);
        study::StudyConfig config = in_file;
        apply_models(arguments->models, config.conditions);
        return campaign::submit(in_file, config, arguments->request);
    };
}

}  // namespace clearway::cli
