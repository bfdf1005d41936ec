// clearway-train: trains link prediction. A program of its own because linking libtorch costs 0.24 s and 90
// MB at each launch; `clearway train` becomes this program.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/number_range.hpp"
#include "samples/dataset_files.hpp"
#include "samples/graph_sample.hpp"
#include "samples/pair_samples.hpp"
#include "training/as_published.hpp"
#include "training/corrected.hpp"
#include "training/logistic.hpp"
#include "training/outputs.hpp"

namespace clearway::training {
namespace {

enum class Mode { as_published, corrected, logistic };

struct Arguments : CommonArguments {
    Mode mode = Mode::as_published;  ///< Set by an option.
    PairChoice pairs = PairChoice::candidates;
    std::vector<std::filesystem::path> unseen;
    CorrectedConfig config;
    LogisticConfig logistic;
};

void declare_options(CLI::App& app, Arguments& arguments) {
    add_folder_options(app, arguments,
                       "Data set of `clearway dataset`; for --corrected, --logistic with --samples",
                       "Folder for the results; made when absent");
    auto* const as_published = app.add_flag_callback(
        "--as-published", [&] { arguments.mode = Mode::as_published; },
        "Train as the dissertation did: one snapshot, no better than a constant");
    auto* const corrected = app.add_flag_callback(
        "--corrected", [&] { arguments.mode = Mode::corrected; },
        "Train on many snapshots, split by seed, without messages along the labels");
    corrected->excludes(as_published);
    auto* const logistic =
        app.add_flag_callback(
               "--logistic", [&] { arguments.mode = Mode::logistic; },
               "Fit the logistic pair model on `clearway dataset --samples --net logistic`")
            ->excludes(corrected)
            ->excludes(as_published);
    app.add_option("--ridge", arguments.logistic.ridge,
                   "Weight of the sum of squared weights, added to the mean loss")
        ->check(core::NumberRange{0.0, 1e6})
        ->option_text(fmt::format("NUMBER, 0 to 1e6 [{:g}]", arguments.logistic.ridge))
        ->needs(logistic)
        ->group("Only with --logistic");
    static const std::map<std::string, PairChoice> pairs = {{"true-links", PairChoice::true_only},
                                                            {"candidates", PairChoice::candidates}};
    app.add_option_function<std::string>(
           "--pairs", [&](const std::string& name) { arguments.pairs = pairs.at(name); },
           "Pairs of the list to use: only those labelled 1, or all")
        ->check(CLI::IsMember(pairs))
        ->option_text("true-links|candidates [candidates]")
        ->excludes(corrected)
        ->excludes(logistic);
    app.add_option("--unseen", arguments.unseen,
                   "Data sets, for example of other seeds, on which the net is scored")
        ->option_text("DIR...")
        ->excludes(corrected)
        ->excludes(logistic);
    add_printing_options(app, arguments.printing);
    add_field_options(app, arguments.config.training, "Training (losses in nat)");
    for (CLI::Option* option : add_field_options(app, arguments.config, "Only with --corrected"))
        option->needs(corrected);
    app.footer(
        "`clearway train graphsage --help` explains how the improved net is trained, `clearway train\n"
        "gradient_boosting --help` how trees are grown on the same data.\n\n"
        "Results: losses.csv, train_test_curve.svg, summary.json, GraphSAGENet.pth (for Python's "
        "torch.load),\n"
        "graphsage_*.weights (for `clearway run city --predictor graphsage_corrected --model FILE`), and\n"
        "predictions.csv or metrics.csv. With --convolution gcn or gat: gcn.pth, gcn.weights or gat.pth,\n"
        "gat.weights. With --logistic: summary.json and logistic.weights. A .pth drives runs as well.\n\n"
        "Examples:\n  clearway dataset city --out data/city\n  clearway train --as-published "
        "--data data/city --out models/mine\n"
        "                                                       (--convolution gcn, gat: others to compare)\n"
        "  clearway train --as-published --data data/city --pairs true-links --seed 1 --out models/true "
        "--json");
}

/// What can be trained, the recommended net first. Printed when the user names none.
constexpr const char* choices =
    "clearway train: which net? Name one of these:\n"
    "  clearway train graphsage --data DIR --out DIR        recommended: the net that repairs links best\n"
    "  clearway train gradient_boosting --data DIR --out DIR  boosted trees on the same data: quick\n"
    "  clearway train --logistic --data DIR --out DIR       a logistic model of pairs: small and quick\n"
    "  clearway train --corrected --data DIR --out DIR      the dissertation's net, trained soundly\n"
    "                                                       (--convolution gcn, gat: others to compare)\n"
    "  clearway train --as-published --data DIR --out DIR   the dissertation's net and training: no better\n"
    "                                                       than a constant, kept for comparison\n"
    "The data set comes from `clearway dataset SCENARIO --out DIR`, with `--samples --net graphsage` (the\n"
    "first two), `--samples --net logistic`, `--samples` and nothing else, in this order. `clearway train "
    "graphsage "
    "--help`\n"
    "and `clearway train --help` describe the options.\n";

/// Whether the arguments name a net, or ask for something other than a training.
bool names_a_net(int argument_count, char** argument_values) {
    for (int i = 1; i < argument_count; ++i) {
        const std::string_view word = argument_values[i];
        if (!word.starts_with("-") && i == 1) return true;  // a word: known, or reported as unknown later
        for (const char* known : {"--as-published", "--corrected", "--logistic", "--help", "-h", "--version"})
            if (word == known) return true;
    }
    return false;
}

/// The dissertation's three lines per epoch, counted from 0 as there.
TrainingHooks hooks_as_published(Printing printing) {
    TrainingHooks hooks;
    hooks.should_stop = stop_requested;
    if (printing != Printing::epochs) return hooks;
    hooks.on_epoch = [](std::uint32_t epoch, const EpochLoss& loss) {
        // Printed with the digits of a float, as Python's item() is there.
        fmt::print("epoch: {}\n=======\nloss: {} {}\n", epoch, loss.train, loss.held_out);
    };
    return hooks;
}

void print_closing(const AsPublishedResult& result) {
    if (result.state.empty()) return;
    print_quality("train", result.train_quality);
    print_quality("test", result.test_quality);
    fmt::print("test log loss of a constant: {:.3f} nat\n", result.constant_test_loss);
    for (const UnseenQuality& unseen : result.unseen) {
        print_quality(unseen.data + ", messages along the listed pairs", unseen.listed);
        print_quality(unseen.data + ", messages along the true links", unseen.true_links);
        print_quality(unseen.data + ", no messages", unseen.no_messages);
    }
    for (const std::string& warning : result.warnings)
        fmt::print(stderr, "clearway-train: note: {}\n", warning);
}

void print_closing(const CorrectedResult& result) {
    if (result.state.empty()) return;
    fmt::print("best epoch {} of {}; seeds: {} training, {} validation, {} test\n", result.best_epoch + 1,
               result.losses.size(), result.seeds.train.size(), result.seeds.validation.size(),
               result.seeds.test.size());
    for (const GroupQuality& group : result.groups) {
        const std::string label =
            group.scenario.empty() ? "test seeds" : group.scenario + " " + group.failure;
        print_quality(label, group.net);
        fmt::print("{}, by dead-reckoned distance alone: AUC {}, AP {}, F1 {}\n", label,
                   figure(group.dead_reckoning.auc), figure(group.dead_reckoning.ap),
                   figure(group.dead_reckoning.f1));
    }
}

template <class Result>
core::ExitCode conclude(const Arguments& arguments, const OutputFolder& folder, const Result& result,
                        const nlohmann::ordered_json& summary) {
    if (arguments.printing == Printing::json) {
        print_json(summary);
    } else {
        print_closing(result);
    }
    return exit_code_for(folder, result.outcome, result.losses.size(), !result.state.empty());
}

core::ExitCode run_as_published(const Arguments& arguments) {
    const samples::PairDataset dataset = samples::read_pair_dataset(arguments.data);
    const RunDescription run{arguments.data,
                             hash_of_files({arguments.data / samples::edge_list_file,
                                            arguments.data / samples::vehicle_features_file,
                                            arguments.data / samples::target_file}),
                             arguments.config.training};
    std::vector<samples::PairDataset> unseen;
    for (const std::filesystem::path& folder : arguments.unseen)
        unseen.push_back(samples::read_pair_dataset(folder));
    const OutputFolder folder(arguments.out, identity_of(arguments.pairs, run));
    AsPublishedResult result = train_as_published(dataset, arguments.pairs, run.training,
                                                  hooks_as_published(arguments.printing), arguments.data);
    for (std::size_t at = 0; at < unseen.size() && !result.state.empty(); ++at) {
        result.unseen.push_back(
            score_unseen(result.state, run.training, unseen[at], arguments.unseen[at].string()));
    }
    const auto summary = summary_of(result, arguments.pairs, run);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, summary, run.training);
    return conclude(arguments, folder, result, summary);
}

core::ExitCode run_corrected(const Arguments& arguments) {
    const std::vector<std::filesystem::path> paths = samples::find_graph_samples(arguments.data);
    const auto files = read_distinct(paths, samples::read_graph_samples).first;
    const RunDescription run{arguments.data, hash_of_files(paths), arguments.config.training};
    const OutputFolder folder(arguments.out, identity_of(arguments.config, run));
    const CorrectedResult result =
        train_corrected(files, arguments.config, hooks_with_lines(arguments.printing, run.training.epochs));
    const auto summary = summary_of(result, arguments.config, run);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, summary, run.training, files.front().origin.features);
    return conclude(arguments, folder, result, summary);
}

core::ExitCode run_logistic(const Arguments& arguments) {
    const std::vector<std::filesystem::path> paths = samples::find_pair_samples(arguments.data);
    const auto files = read_distinct(paths, samples::read_pair_samples).first;
    LogisticConfig config = arguments.logistic;
    config.seed = arguments.config.training.seed;
    const std::string data_hash = hash_of_files(paths);
    const OutputFolder folder(arguments.out, identity_of(config, data_hash));
    const LogisticResult result = train_logistic(files, config);
    const auto summary = summary_of(result, config, arguments.data, data_hash);
    write_outputs(folder.path(), result, summary);
    if (arguments.printing == Printing::json) {
        print_json(summary);
        return core::ExitCode::ok;
    }
    fmt::print("{} Newton steps, {}; training log loss {:.4f} nat over {} pairs\n", result.iterations,
               result.converged ? "converged" : "not converged", result.train_loss, result.train_pairs);
    for (const LogisticGroup& group : result.groups) {
        print_quality(group.scenario.empty() ? "test seeds" : group.scenario + " " + group.failure,
                      group.quality);
    }
    return core::ExitCode::ok;
}

core::ExitCode train_as(const Arguments& arguments) {
    switch (arguments.mode) {
        case Mode::as_published:
            return run_as_published(arguments);
        case Mode::corrected:
            return run_corrected(arguments);
        case Mode::logistic:
            return run_logistic(arguments);
    }
    throw std::logic_error("a mode of training without its function");
}

int run(int argument_count, char** argument_values) {
    if (argument_count > 1 && std::string_view(argument_values[1]) == graphsage_word) {
        return run_graphsage(argument_count - 1, argument_values + 1);
    }
    if (argument_count > 1 && std::string_view(argument_values[1]) == gradient_boosting_word) {
        return run_gradient_boosting(argument_count - 1, argument_values + 1);
    }
    if (!names_a_net(argument_count, argument_values)) {
        fmt::print(stderr, "{}", choices);
        return static_cast<int>(core::ExitCode::usage);
    }
    CLI::App app("Trains the dissertation's GraphSAGENet for link prediction, as published or corrected.");
    app.name("clearway train");
    app.set_version_flag("--version", "clearway-train " CLEARWAY_VERSION);
    Arguments arguments;
    declare_options(app, arguments);
    return parse_and_train(app, argument_count, argument_values, [&] {
        core::make_folder(arguments.out);
        return train_as(arguments);
    });
}

}  // namespace
}  // namespace clearway::training

int main(int argument_count, char** argument_values) {
    using clearway::core::ExitCode;
    try {
        return clearway::training::run(argument_count, argument_values);
    } catch (const clearway::core::Error& error) {
        fmt::print(stderr, "clearway-train: {}\n", error.what());
        return static_cast<int>(error.exit_code());
    } catch (const std::exception& error) {
        fmt::print(stderr, "clearway-train: {}\n", error.what());
        return static_cast<int>(ExitCode::environment);
    }
}
