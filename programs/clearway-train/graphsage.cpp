// clearway train graphsage: the improved net.
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
#include "training/repair.hpp"
#include "training/repair_outputs.hpp"

namespace clearway::training {
namespace {

struct Arguments {
    std::filesystem::path data;
    std::filesystem::path out;
    Printing printing = Printing::epochs;
    RepairConfig config;
};

void declare_options(CLI::App& app, Arguments& arguments) {
    app.add_option("--data", arguments.data, "Data set of `clearway dataset --samples --net graphsage`")
        ->required()
        ->option_text("DIR (required)");
    app.add_option("--out", arguments.out,
                   "Folder for the results and the checkpoint; a training found there is continued")
        ->required()
        ->option_text("DIR (required)");
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

void print_closing(const RepairResult& result) {
    fmt::print("{} parameters; best epoch {} of {}; seeds: {} training, {} validation, {} test\n",
               result.parameter_count, result.best_epoch + 1, result.losses.size(), result.seeds.train.size(),
               result.seeds.validation.size(), result.seeds.test.size());
    for (const RepairGroup& group : result.groups) {
        std::string label = group.failure.empty() ? "all test seeds" : group.failure;
        if (!group.scenario.empty()) label += ", " + group.scenario;
        print_quality(label, group.net);
        print_quality("  route rule", group.rule);
    }
}

core::ExitCode train(const Arguments& arguments) {
    const std::vector<std::filesystem::path> paths = samples::find_graph_samples(arguments.data);
    const auto [files, hashes] = read_distinct(paths, samples::read_repair_samples);
    const Checkpoint checkpoint{arguments.out, core::content_hash(fmt::format("{}", fmt::join(hashes, "")))};
    const OutputFolder folder(arguments.out, identity_of(arguments.config, checkpoint.data_hash));
    const RepairResult result = train_repair(files, arguments.config, checkpoint,
                                             hooks_with_lines(arguments.printing, arguments.config.epochs));
    const nlohmann::ordered_json summary =
        summary_of(result, arguments.config, arguments.data, checkpoint.data_hash);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, arguments.config, summary);
    if (arguments.printing == Printing::json) {
        print_json(summary);
    } else if (!result.groups.empty()) {
        print_closing(result);
    }
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
