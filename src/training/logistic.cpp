#include "training/logistic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/logistic.hpp"
#include "training/detail/figures.hpp"
#include "training/detail/sample_parts.hpp"

namespace clearway::training {
namespace {

using detail::json_from;
using prediction::pair_feature_count;
using samples::PairSampleFile;

/// The last parameter is the bias.
constexpr std::size_t parameter_count = pair_feature_count + 1;
using Parameters = std::array<double, parameter_count>;
using Curvature = std::array<Parameters, parameter_count>;

Parameters inputs(const prediction::PairFeatures& features) {
    Parameters row{};
    std::ranges::copy(features, row.begin());
    row.back() = 1.0;
    return row;
}

double probability(const Parameters& parameters, const prediction::PairFeatures& features) {
    double logit = parameters.back();
    for (std::size_t i = 0; i < pair_feature_count; ++i) {
        logit += parameters[i] * features[i];
    }
    return 1.0 / (1.0 + std::exp(-logit));
}

/// Gradient and curvature of the mean log loss with ridge.
struct Slope {
    double loss = 0.0;
    Parameters gradient{};
    Curvature curvature{};
};

Slope slope_at(const Parameters& parameters, const std::vector<const PairSampleFile*>& files, double ridge) {
    Slope slope;
    double pairs = 0.0;
    for (const PairSampleFile* const file : files) {
        for (std::size_t pair = 0; pair < file->linked.size(); ++pair) {
            const Parameters row = inputs(file->features[pair]);
            const double p = probability(parameters, file->features[pair]);
            const bool linked = file->linked[pair] == 1;
            slope.loss -= std::log(std::max(1e-300, linked ? p : 1.0 - p));
            const double error = p - (linked ? 1.0 : 0.0);
            for (std::size_t i = 0; i < parameter_count; ++i) {
                slope.gradient[i] += error * row[i];
                for (std::size_t j = 0; j <= i; ++j) {
                    slope.curvature[i][j] += p * (1.0 - p) * row[i] * row[j];
                }
            }
        }
        pairs += static_cast<double>(file->linked.size());
    }
    slope.loss /= pairs;
    for (std::size_t i = 0; i < parameter_count; ++i) {
        slope.gradient[i] = slope.gradient[i] / pairs + ridge * parameters[i];
        for (std::size_t j = 0; j <= i; ++j) {
            slope.curvature[i][j] /= pairs;
        }
        slope.curvature[i][i] += ridge;
    }
    return slope;
}

/// Solves curvature x step = gradient by Cholesky decomposition of the lower half; nothing when it is not
/// positive definite.
std::optional<Parameters> newton_step(Curvature lower, const Parameters& gradient) {
    Parameters step = gradient;
    for (std::size_t i = 0; i < parameter_count; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = lower[i][j];
            for (std::size_t k = 0; k < j; ++k) {
                sum -= lower[i][k] * lower[j][k];
            }
            if (i == j && !(sum > 0.0)) return std::nullopt;
            lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
        }
        for (std::size_t k = 0; k < i; ++k) {
            step[i] -= lower[i][k] * step[k];
        }
        step[i] /= lower[i][i];
    }
    for (std::size_t i = parameter_count; i-- > 0;) {
        for (std::size_t k = i + 1; k < parameter_count; ++k) {
            step[i] -= lower[k][i] * step[k];
        }
        step[i] /= lower[i][i];
    }
    return step;
}

/// Newton's method, each step halved until it does not raise the loss.
Parameters fit(const std::vector<const PairSampleFile*>& files, const LogisticConfig& config,
               LogisticResult& result) {
    constexpr int most_halvings = 20;
    Parameters parameters{};
    Slope slope = slope_at(parameters, files, config.ridge);
    while (result.iterations < config.most_iterations && !result.converged) {
        const auto step = newton_step(slope.curvature, slope.gradient);
        if (!step) {
            throw core::InputError({"--data",
                                    "a feature is the same in all training pairs, or follows from others", "",
                                    "Record more varied traffic and failures, or give a --ridge above 0"});
        }
        double scale = 1.0;
        for (int halving = 0;; ++halving, scale /= 2.0) {
            Parameters next = parameters;
            for (std::size_t i = 0; i < parameter_count; ++i) {
                next[i] -= scale * (*step)[i];
            }
            Slope there = slope_at(next, files, config.ridge);
            if (there.loss > slope.loss + 1e-12 && halving < most_halvings) continue;
            slope = there;
            parameters = next;
            break;
        }
        ++result.iterations;
        result.converged = std::ranges::all_of(
            *step, [&](double change) { return std::abs(scale * change) <= config.tolerance; });
    }
    result.train_loss = slope.loss;
    return parameters;
}

std::vector<const PairSampleFile*> files_of(const std::vector<PairSampleFile>& files,
                                            const std::vector<DataSeed>& seeds, const char* part) {
    std::vector<const PairSampleFile*> chosen;
    detail::LabelCounts counts;
    for (const PairSampleFile& file : files) {
        if (file.linked.empty() || !detail::is_of(file, seeds)) continue;
        counts.add(file.linked);
        chosen.push_back(&file);
    }
    detail::require_both_classes(counts, part);
    return chosen;
}

void require_one_radius(const std::vector<PairSampleFile>& files) {
    for (const PairSampleFile& file : files) {
        if (file.origin.link_radius_m == files.front().origin.link_radius_m) continue;
        throw core::InputError(
            {fmt::format("--data: {}, {}, replication {}", file.origin.scenario, file.origin.failure,
                         file.origin.replication),
             fmt::format("links below {} m", file.origin.link_radius_m),
             fmt::format("{} m, as in the other files", files.front().origin.link_radius_m),
             "Record all files with one link radius"});
    }
}

struct GroupScores {
    std::vector<double> probability;
    std::vector<std::uint8_t> linked;

    void add(const Parameters& parameters, const PairSampleFile& file) {
        for (const prediction::PairFeatures& features : file.features) {
            probability.push_back(training::probability(parameters, features));
        }
        linked.insert(linked.end(), file.linked.begin(), file.linked.end());
    }
    metrics::ScoredLinks links() const { return {probability, linked}; }
};

void measure(const Parameters& parameters, const std::vector<PairSampleFile>& files, LogisticResult& result) {
    GroupScores validation, all;
    for (const PairSampleFile* const file : files_of(files, result.seeds.validation, "validation")) {
        validation.add(parameters, *file);
    }
    result.threshold = metrics::best_f1_threshold(validation.links());
    std::map<std::pair<std::string, std::string>, GroupScores> groups;
    for (const PairSampleFile* const file : files_of(files, result.seeds.test, "test")) {
        groups[{file->origin.scenario, file->origin.failure}].add(parameters, *file);
        all.add(parameters, *file);
    }
    result.groups.push_back({"", "", metrics::link_quality(all.links(), result.threshold)});
    for (const auto& [name, scores] : groups) {
        result.groups.push_back(
            {name.first, name.second, metrics::link_quality(scores.links(), result.threshold)});
    }
}

}  // namespace

LogisticResult train_logistic(const std::vector<PairSampleFile>& files, const LogisticConfig& config) {
    require_one_radius(files);
    LogisticResult result;
    result.link_radius_m = files.front().origin.link_radius_m;
    result.seeds = detail::split_files(
        files, {.seed = config.seed, .validation = config.validation_share, .test = config.test_share});

    const std::vector<const PairSampleFile*> train = files_of(files, result.seeds.train, "training");
    for (const PairSampleFile* const file : train) {
        result.train_pairs += file->linked.size();
    }
    const Parameters parameters = fit(train, config, result);
    std::ranges::transform(parameters.begin(), parameters.end() - 1, result.weight.begin(),
                           [](double value) { return static_cast<float>(value); });
    result.bias = parameters.back();
    measure(parameters, files, result);
    return result;
}

Identity identity_of(const LogisticConfig& config, const std::string& data_hash) {
    return {{"mode", "logistic"}, {"data_hash", data_hash}, {"configuration", json_from(config)}};
}

nlohmann::ordered_json summary_of(const LogisticResult& result, const LogisticConfig& config,
                                  const std::filesystem::path& data, const std::string& data_hash) {
    nlohmann::ordered_json summary = detail::summary_start(
        identity_of(config, data_hash), result.converged ? "finished" : "iterations_used_up", data);
    summary["iterations"] = result.iterations;
    summary["seeds"] = json_from(result.seeds);
    summary["train_pair_count"] = result.train_pairs;
    summary["final_train_loss_nat"] = result.train_loss;
    for (std::size_t i = 0; i < pair_feature_count; ++i) {
        summary["weights"][std::string(prediction::pair_feature_names[i])] = result.weight[i];
    }
    summary["bias"] = result.bias;
    summary["test"] = nlohmann::ordered_json::array();
    for (const LogisticGroup& group : result.groups) {
        summary["test"].push_back({{"scenario", group.scenario.empty() ? "all" : group.scenario},
                                   {"failure", group.failure.empty() ? "all" : group.failure},
                                   {"model", json_from(group.quality)}});
    }
    return summary;
}

void write_outputs(const std::filesystem::path& folder, const LogisticResult& result,
                   const nlohmann::ordered_json& summary) {
    prediction::Weights weights;
    weights.architecture = prediction::logistic_architecture;
    weights.features = prediction::pair_feature_schema();
    weights.link_radius = {result.link_radius_m, result.link_radius_m};
    weights.notes.push_back(fmt::format("trained by clearway train, logistic, seed {}, data {}",
                                        summary["configuration"]["seed"].get<std::uint64_t>(),
                                        summary["data_hash"].get<std::string>()));
    weights.tensors = {{"weight",
                        {1, static_cast<std::uint32_t>(pair_feature_count)},
                        {result.weight.begin(), result.weight.end()}},
                       {"bias", {1}, {static_cast<float>(result.bias)}}};
    core::make_folder(folder);
    prediction::write_weights(folder / "logistic.weights", weights);
    core::write_atomically(
        folder / "summary.json",
        summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace clearway::training
