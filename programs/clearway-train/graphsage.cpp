// clearway train graphsage: the improved net.
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "training/repair.hpp"
#include "training/repair_outputs.hpp"

namespace clearway::training {
namespace {

struct Arguments : CommonArguments {
    RepairConfig config;
};

void declare_options(CLI::App& app, Arguments& arguments) {
    add_folder_options(app, arguments, repair_data_doc,
                       "Folder for the results and the checkpoint; a training found there is continued");
    add_printing_options(app, arguments.printing);
    add_field_options(app, arguments.config, "Training (losses in nat)");
    app.footer(
        "Results: losses.csv, train_test_curve.svg, summary.json, metrics.csv, and, unless an option makes "
        "a net for\n"
        "comparison only (ablation), graphsage.weights (for `clearway run city --predictor graphsage "
        "--model FILE`).\n\n"
        "Example:\n"
        "  clearway dataset city --dense --samples --net graphsage --failure B10 C.link --seeds 10 --out "
        "data/graphsage\n"
        "  clearway train graphsage --data data/graphsage --out trained/graphsage");
}

core::ExitCode train(const Arguments& arguments) {
    const RepairData data = read_repair_data(arguments.data);
    const OutputFolder folder(arguments.out, identity_of(arguments.config, data.hash));
    const RepairResult result = train_repair(data.files, arguments.config, {arguments.out, data.hash},
                                             hooks_with_lines(arguments.printing, arguments.config.epochs));
    const nlohmann::ordered_json summary = summary_of(result, arguments.config, arguments.data, data.hash);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, arguments.config, summary);
    print_result(arguments.printing, result, summary,
                 fmt::format("{} parameters; best epoch {} of {}", result.parameter_count,
                             result.best_epoch + 1, result.losses.size()));
    return exit_code_for(folder, result.outcome, result.losses.size(), !result.state.empty());
}

}  // namespace

int run_graphsage(int argument_count, char** argument_values) {
    CLI::App app("Trains the improved net of link prediction, `graphsage`, on a mixture of failures.");
    app.name("clearway train graphsage");
    Arguments arguments;
    declare_options(app, arguments);
    return parse_and_train(app, argument_count, argument_values, [&] {
        core::make_folder(arguments.out);
        return train(arguments);
    });
}

}  // namespace clearway::training
