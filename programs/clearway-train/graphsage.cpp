// clearway train graphsage: the improved net.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "core/files.hpp"
#include "prediction/graph_sample.hpp"
#include "prediction/repair_sample.hpp"
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
                   "Folder for the results and the checkpoint; a training found there goes on")
        ->required()
        ->option_text("DIR (required)");
    app.add_flag_callback(
        "--quiet", [&] { arguments.printing = Printing::closing_only; },
        "Do not print the losses of each epoch");
    app.add_flag_callback(
        "--json", [&] { arguments.printing = Printing::json; },
        "Print the summary as JSON, and nothing else");
    add_field_options(app, arguments.config, "Training (losses in nat)");
    app.footer(
        "Results: losses.csv, train_test_curve.svg, summary.json, metrics.csv, and graphsage.weights (for "
        "--predictor graphsage\n"
        "--model FILE) unless an option makes a net that only serves to compare (ablation).\n\n"
        "Example:\n"
        "  clearway dataset city --dense --samples --net graphsage --failure A.5 B10 C.link --seeds 10 --out "
        "data/graphsage\n"
        "  clearway train graphsage --data data/graphsage --out trained/graphsage");
}

TrainingHooks hooks_for(const Arguments& arguments) {
    TrainingHooks hooks;
    hooks.should_stop = stop_requested;
    if (arguments.printing != Printing::epochs) return hooks;
    const auto started = std::chrono::steady_clock::now();
    hooks.on_epoch = [started, epochs = arguments.config.epochs](std::uint32_t epoch, const EpochLoss& loss) {
        const double passed_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        fmt::print("epoch {} of {}: training loss {:.5f}, validation loss {:.5f} nat, {:.0f} s\n", epoch + 1,
                   epochs, loss.train, loss.held_out, passed_s);
        std::fflush(stdout);
    };
    return hooks;
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
    const std::vector<std::filesystem::path> paths = prediction::find_graph_samples(arguments.data);
    std::vector<prediction::RepairSampleFile> files;
    std::string hashes;
    for (const std::filesystem::path& path : paths) {
        files.push_back(prediction::read_repair_samples(path));
        hashes += files.back().content_hash;
    }
    const Checkpoint checkpoint{arguments.out, core::content_hash(hashes)};
    const RepairResult result = train_repair(files, arguments.config, checkpoint, hooks_for(arguments));
    const nlohmann::ordered_json summary =
        summary_of(result, arguments.config, arguments.data, checkpoint.data_hash);
    write_outputs(arguments.out, result, arguments.config, summary);
    if (arguments.printing == Printing::json) {
        fmt::print("{}\n", summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else if (!result.groups.empty()) {
        print_closing(result);
    }
    return exit_code_for(result.outcome, result.losses, !result.state.empty());
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
