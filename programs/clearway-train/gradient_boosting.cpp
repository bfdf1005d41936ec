// clearway train gradient_boosting: boosted trees on the data of the improved net.
#include "training/gradient_boosting.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "core/files.hpp"
#include "samples/graph_sample.hpp"
#include "samples/repair_sample.hpp"
#include "training/outputs.hpp"

namespace clearway::training {
namespace {

struct Arguments {
    std::filesystem::path data;
    std::filesystem::path out;
    Printing printing = Printing::epochs;
    BoostingConfig config;
};

void declare_options(CLI::App& app, Arguments& arguments) {
    app.add_option("--data", arguments.data, "Data set of `clearway dataset --samples --net graphsage`")
        ->required()
        ->option_text("DIR (required)");
    app.add_option("--out", arguments.out, "Folder for the results; made when absent")
        ->required()
        ->option_text("DIR (required)");
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

void print_closing(const BoostingResult& result) {
    fmt::print("{} of {} trees kept; seeds: {} training, {} validation, {} test\n", result.best_tree + 1,
               result.losses.size(), result.seeds.train.size(), result.seeds.validation.size(),
               result.seeds.test.size());
    for (const BoostingGroup& group : result.groups) {
        std::string label = group.failure.empty() ? "all test seeds" : group.failure;
        if (!group.scenario.empty()) label += ", " + group.scenario;
        print_quality(label, group.trees);
        print_quality("  route rule", group.rule);
    }
}

core::ExitCode train(const Arguments& arguments) {
    const std::vector<std::filesystem::path> paths = samples::find_graph_samples(arguments.data);
    const auto [files, hashes] = read_distinct(paths, samples::read_repair_samples);
    const std::string data_hash = core::content_hash(fmt::format("{}", fmt::join(hashes, "")));
    const OutputFolder folder(arguments.out, identity_of(arguments.config, data_hash));
    const BoostingResult result = train_gradient_boosting(
        files, arguments.config, hooks_with_lines(arguments.printing, arguments.config.trees, "tree"));
    const nlohmann::ordered_json summary = summary_of(result, arguments.config, arguments.data, data_hash);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, summary);
    if (arguments.printing == Printing::json) {
        print_json(summary);
    } else if (!result.groups.empty()) {
        print_closing(result);
    }
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
