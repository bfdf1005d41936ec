// What only compares, and what repeats the dissertation.
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common.hpp"
#include "samples/graph_sample.hpp"
#include "samples/pair_samples.hpp"
#include "training/comparison/as_published.hpp"
#include "training/comparison/corrected.hpp"
#include "training/comparison/logistic.hpp"

namespace clearway::training {
namespace {

constexpr const char* training_group = "Training (losses in nat)";
constexpr const char* net_results =
    "losses.csv, train_test_curve.svg, summary.json, metrics.csv, and the net twice: as NET.weights (for "
    "`clearway "
    "run city --predictor NET --model FILE`) and as a .pth for Python's torch.load, which drives runs as "
    "well.";

struct AsPublishedArguments {
    TrainingConfig config;
    PairChoice pairs = PairChoice::candidates;
    std::vector<std::filesystem::path> unseen;
};

/// The dissertation's three lines per epoch, counted from 0 as there.
TrainingHooks hooks_as_published(Printing printing) {
    TrainingHooks hooks = hooks_with_lines(Printing::closing_only, 0);
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

core::ExitCode train_published(const CommonArguments& arguments, const AsPublishedArguments& own) {
    const samples::PairDataset dataset = samples::read_pair_dataset(arguments.data);
    const Identity identity = identity_of(own.pairs, own.config,
                                          hash_of_files({arguments.data / samples::edge_list_file,
                                                         arguments.data / samples::vehicle_features_file,
                                                         arguments.data / samples::target_file}));
    std::vector<samples::PairDataset> unseen;
    for (const std::filesystem::path& folder : own.unseen)
        unseen.push_back(samples::read_pair_dataset(folder));
    const OutputFolder folder(arguments.out, identity);
    AsPublishedResult result = train_as_published(dataset, own.pairs, own.config,
                                                  hooks_as_published(arguments.printing), arguments.data);
    for (std::size_t at = 0; at < unseen.size() && !result.state.empty(); ++at)
        result.unseen.push_back(score_unseen(result.state, own.config, unseen[at], own.unseen[at].string()));
    if (arguments.printing != Printing::json) print_closing(result);
    return conclude(arguments, folder, result, identity, "");
}

std::function<core::ExitCode()> configure_as_published(CLI::App& app, CommonArguments& arguments) {
    const auto own = std::make_shared<AsPublishedArguments>();
    static const std::map<std::string, PairChoice> pairs = {{"true-links", PairChoice::true_only},
                                                            {"candidates", PairChoice::candidates}};
    app.add_option_function<std::string>(
           "--pairs", [own](const std::string& name) { own->pairs = pairs.at(name); },
           "Pairs of the list to use: only those labelled 1, or all")
        ->check(CLI::IsMember(pairs))
        ->option_text("true-links|candidates [candidates]");
    app.add_option("--unseen", own->unseen,
                   "Data sets, for example of other seeds, on which the net is scored")
        ->option_text("DIR...");
    add_field_options(app, own->config, training_group);
    return [&arguments, own] { return train_published(arguments, *own); };
}

template <Convolution convolution>
std::function<core::ExitCode()> configure_corrected(CLI::App& app, CommonArguments& arguments) {
    const auto config = std::make_shared<CorrectedConfig>();
    config->convolution = convolution;
    add_field_options(app, config->training, training_group);
    add_field_options(app, *config, training_group);
    return [&arguments, config] {
        const std::vector<std::filesystem::path> paths = samples::find_graph_samples(arguments.data);
        const auto files = read_distinct(paths, samples::read_graph_samples).first;
        const Identity identity = identity_of(*config, hash_of_files(paths));
        const OutputFolder folder(arguments.out, identity);
        const CorrectedResult result =
            train_corrected(files, *config, hooks_with_lines(arguments.printing, config->training.epochs));
        return conclude(arguments, folder, result, identity,
                        fmt::format("best epoch {} of {}", result.best_round + 1, result.losses.size()));
    };
}

std::function<core::ExitCode()> configure_logistic(CLI::App& app, CommonArguments& arguments) {
    const auto config = std::make_shared<LogisticConfig>();
    add_field_options(app, *config, training_group);
    return [&arguments, config] {
        const std::vector<std::filesystem::path> paths = samples::find_pair_samples(arguments.data);
        const auto files = read_distinct(paths, samples::read_pair_samples).first;
        const Identity identity = identity_of(*config, hash_of_files(paths));
        const OutputFolder folder(arguments.out, identity);
        const LogisticResult result = train_logistic(files, *config);
        return conclude(arguments, folder, result, identity,
                        fmt::format("{} Newton steps, {}; training log loss {:.4f} nat over {} pairs",
                                    result.iterations, result.converged ? "converged" : "not converged",
                                    result.train_loss, result.train_pairs));
    };
}

constexpr Net comparisons[] = {
    {"logistic", "a logistic model of pairs: small and quick", "--samples --net logistic",
     "summary.json, metrics.csv and logistic.weights.", configure_logistic},
    {"graphsage_corrected", "the dissertation's net, trained soundly: on many snapshots, split by seed",
     "--samples", net_results, configure_corrected<Convolution::sage>},
    {"gcn", "the same with graph convolutions (Kipf and Welling)", "--samples", net_results,
     configure_corrected<Convolution::gcn>},
    {"gat", "the same with graph attention (Velickovic et al.)", "--samples", net_results,
     configure_corrected<Convolution::gat>},
    {"graphsage_as_published",
     "the dissertation's net and training on one snapshot: no better than a constant", "",
     "losses.csv, train_test_curve.svg, summary.json, predictions.csv, graphsage_as_published.weights and "
     "GraphSAGENet.pth (for Python's torch.load, and for runs as well).",
     configure_as_published}};

}  // namespace

std::span<const Net> comparison_nets() {
    return comparisons;
}

}  // namespace clearway::training
