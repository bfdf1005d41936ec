// The learned repairs: the improved net, and boosted trees on the same data.
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common.hpp"
#include "samples/graph_sample.hpp"
#include "training/gradient_boosting.hpp"
#include "training/repair.hpp"

namespace clearway::training {
namespace {

constexpr const char* data_options = "--samples --net graphsage";

struct RepairData {
    std::vector<samples::RepairSampleFile> files;
    std::string hash;
};
RepairData read_repair_data(const std::filesystem::path& folder) {
    auto [files, hashes] = read_distinct(samples::find_graph_samples(folder), samples::read_repair_samples);
    return {std::move(files), core::content_hash(fmt::format("{}", fmt::join(hashes, "")))};
}

core::ExitCode train_graphsage(const CommonArguments& arguments, const RepairConfig& config) {
    const RepairData data = read_repair_data(arguments.data);
    const Identity identity = identity_of(config, data.hash);
    const OutputFolder folder(arguments.out, identity);
    const RepairResult result = train_repair(data.files, config, {arguments.out, data.hash},
                                             hooks_with_lines(arguments.printing, config.epochs));
    return conclude(arguments, folder, result, identity,
                    fmt::format("{} parameters; best epoch {} of {}", result.parameter_count,
                                result.best_round + 1, result.losses.size()));
}

core::ExitCode train_trees(const CommonArguments& arguments, const BoostingConfig& config) {
    const RepairData data = read_repair_data(arguments.data);
    const Identity identity = identity_of(config, data.hash);
    const OutputFolder folder(arguments.out, identity);
    const BoostingResult result = train_gradient_boosting(
        data.files, config, hooks_with_lines(arguments.printing, config.trees, "tree"));
    return conclude(arguments, folder, result, identity,
                    fmt::format("{} of {} trees kept", result.best_round + 1, result.losses.size()));
}

/// Options are those of a `Config`.
template <class Config, core::ExitCode (*train)(const CommonArguments&, const Config&)>
std::function<core::ExitCode()> configure(CLI::App& app, CommonArguments& arguments) {
    const auto config = std::make_shared<Config>();
    add_field_options(app, *config, "Training (losses in nat)");
    return [&arguments, config] { return train(arguments, *config); };
}

constexpr Net repairs[] = {
    {"graphsage", "recommended: the net that repairs links best", data_options,
     "losses.csv, train_test_curve.svg, summary.json, metrics.csv, checkpoints from which the same command "
     "goes "
     "on, and, unless an option makes a net for comparison only (ablation), graphsage.weights (for `clearway "
     "run "
     "city --predictor graphsage --model FILE`).",
     configure<RepairConfig, train_graphsage>},
    {"gradient_boosting", "boosted trees on the same data: quick", data_options,
     "losses.csv (a row per tree), train_test_curve.svg, summary.json, metrics.csv and "
     "gradient_boosting.weights "
     "(for `clearway run city --predictor gradient_boosting --model FILE`).",
     configure<BoostingConfig, train_trees>}};

}  // namespace

std::span<const Net> repair_nets() {
    return repairs;
}

}  // namespace clearway::training
