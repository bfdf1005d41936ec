// clearway train gradient_boosting: boosted trees on the data of the improved net.
#include "training/gradient_boosting.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"

namespace clearway::training {
namespace {

struct Arguments : CommonArguments {
    BoostingConfig config;
};

void declare_options(CLI::App& app, Arguments& arguments) {
    add_folder_options(app, arguments, repair_data_doc, "Folder for the results; made when absent");
    add_printing_options(app, arguments.printing);
    add_field_options(app, arguments.config, "Training (losses in nat)");
    app.footer(
        "Results: losses.csv (a row per tree), train_test_curve.svg, summary.json, metrics.csv and\n"
        "gradient_boosting.weights, for `clearway run city --predictor gradient_boosting --model FILE`.\n\n"
        "Example:\n"
        "  clearway dataset city --dense --samples --net graphsage --failure B10 --seeds 10 \\\n"
        "      --out data/graphsage\n"
        "  clearway train gradient_boosting --data data/graphsage --out trained/trees");
}

core::ExitCode train(const Arguments& arguments) {
    const RepairData data = read_repair_data(arguments.data);
    const OutputFolder folder(arguments.out, identity_of(arguments.config, data.hash));
    const BoostingResult result = train_gradient_boosting(
        data.files, arguments.config, hooks_with_lines(arguments.printing, arguments.config.trees, "tree"));
    const nlohmann::ordered_json summary = summary_of(result, arguments.config, arguments.data, data.hash);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, summary);
    print_result(arguments.printing, result, summary,
                 fmt::format("{} of {} trees kept", result.best_tree + 1, result.losses.size()));
    return exit_code_for(folder, result.outcome, result.losses.size(), !result.losses.empty(), "tree");
}

}  // namespace

int run_gradient_boosting(int argument_count, char** argument_values) {
    CLI::App app("Grows boosted trees for link prediction on the data of the improved net.");
    app.name("clearway train gradient_boosting");
    Arguments arguments;
    declare_options(app, arguments);
    return parse_and_train(app, argument_count, argument_values, [&] {
        core::make_folder(arguments.out);
        return train(arguments);
    });
}

}  // namespace clearway::training
