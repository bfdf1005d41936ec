#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/link_evaluation.hpp"
#include "campaign/study_run.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/interruption.hpp"

namespace clearway::cli {
namespace {

struct EvaluateArguments {
    campaign::LinkRequest request;
    std::vector<std::string> settings;  ///< `link_threshold=0.4`, `kalman.link_threshold=0.4`.
    std::vector<std::string> models;    ///< `graphsage=FILE`.
};

void add_what(App& app, EvaluateArguments& arguments) {
    app.add_option("scenario", arguments.request.scenarios,
                   "Names (clearway list), folders or TOML files; with --benchmark, names of its scenarios")
        .option_text("SCENARIO ... [those of the benchmark]");
    app.add_option("--benchmark", arguments.request.benchmark,
                   "Scenarios, seeds and failures of a benchmark: eval_v1, eval_v2 or a TOML file")
        .option_text("NAME|FILE [none]");
    app.add_option("--failure", arguments.request.failures, "Sensor failures (clearway list)")
        .option_text("NAME ... [all]");
    app.add_option("--exits", arguments.request.exits,
                   "Whether it is known that a vehicle has left the network")
        .one_of({"known", "unknown", "both"})
        .option_text("known|unknown|both [both]");
    app.add_option("--predictor", arguments.request.predictors,
                   "Predictors (clearway list, FILE.py:CLASS, FILE.pt)")
        .option_text("NAME ... [all, or the benchmark's]");
    app.add_option("--model", arguments.models, "Model file of a learned predictor")
        .option_text("PREDICTOR=FILE ... [as shipped]");
    app.add_option("--set", arguments.settings, "A setting of all predictors, or of one")
        .option_text("[PREDICTOR.]NAME=NUMBER ... [defaults]");
    app.add_option("--against", arguments.request.against,
                   "Predictor to compare errors with; by default the best kinematic one present")
        .option_text("PREDICTOR [route_rule, kalman, ...]");
}

void add_seeds(App& app, EvaluateArguments& arguments) {
    const OptionGroup group(app, "Seeds (a benchmark has its own)");
    const auto declare = [&](const char* name, std::uint32_t& value, const char* doc, std::uint32_t least) {
        app.add_option(name, value, doc)
            .range(least, 4000000000U)
            .option_text(fmt::format("N, from {} [{}]", least, value))
            .excludes("--benchmark");
    };
    add_seed_option(app, arguments.request.study_seed).excludes("--benchmark");
    declare("--seeds", arguments.request.test.count, "Replications to test on", 0U);
    declare("--first-seed", arguments.request.test.first, "Number of the first of them", 0U);
    declare("--validation-seeds", arguments.request.validation.count,
            "Replications on which F1 thresholds are chosen", 0U);
    declare("--first-validation-seed", arguments.request.validation.first, "Number of the first of them", 0U);
    app.add_flag("--quick", arguments.request.quick,
                 fmt::format("At most {} test and {} validation seeds, or what the benchmark says [all]",
                             links::QuickBenchmark{}.test, links::QuickBenchmark{}.validation));
    app.add_choice("--split", arguments.request.split,
                   {{"test", links::LinkSplit::test}, {"validation", links::LinkSplit::validation}},
                   "Seeds whose results are printed; tune settings only on `validation`")
        .option_text("test|validation [test]");
}

}  // namespace

Action configure_evaluate(App& app) {
    const auto arguments = std::make_shared<EvaluateArguments>();
    add_what(app, *arguments);
    app.add_option("--out", arguments->request.folder,
                   "Folder of runs and results; runs that it already holds are not repeated")
        .option_text("DIR [runs/BENCHMARK, or runs/links]");
    add_jobs_option(app, arguments->request.workers);
    add_publish_options(app, arguments->request.publication);
    add_json_option(app, arguments->request.printing, "all figures");
    add_seeds(app, *arguments);
    const std::size_t own_options = app.get_options().size();
    {
        const OptionGroup group(app, "Links");
        add_link_options(app, arguments->request.links);
    }
    add_scenario_options(app, arguments->request.options);
    add_override_option(app, arguments->request.options);
    const std::vector<Option> options = app.get_options();
    for (std::size_t i = own_options; i < options.size(); ++i)
        options[i].excludes("--benchmark");
    app.footer(
        "Examples:\n  clearway links evaluate --benchmark eval_v1\n"
        "  clearway links evaluate city --dense --failure B10 B20 --predictor dead_reckoning last_seen "
        "--json\n"
        "  clearway links evaluate --benchmark eval_v1 --split validation --failure B10 --set "
        "link_threshold=0.4");
    return [arguments](const Invocation& invocation) {
        const core::InterruptionNotice notice(campaign::interrupted_between_runs(invocation.command));
        campaign::LinkRequest& request = arguments->request;
        request.command = invocation.command;
        for (const std::string& words : arguments->settings)
            request.settings.push_back(assignment("--set", words));
        for (const std::string& words : arguments->models)
            request.models.push_back(assignment("--model", words, "PREDICTOR=FILE"));
        return campaign::evaluate_links(request);
    };
}

}  // namespace clearway::cli
