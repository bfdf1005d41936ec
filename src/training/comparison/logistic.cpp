#include "training/comparison/logistic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "prediction/comparison/logistic.hpp"
#include "training/detail/figures.hpp"

namespace clearway::training {
namespace {

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

double logit_of(const Parameters& parameters, const prediction::PairFeatures& features) {
    double logit = parameters.back();
    for (std::size_t i = 0; i < pair_feature_count; ++i) {
        logit += parameters[i] * features[i];
    }
    return logit;
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
            const double p = 1.0 / (1.0 + std::exp(-logit_of(parameters, file->features[pair])));
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
    constexpr std::uint32_t most_iterations = 50;  // About 10 are needed.
    constexpr double tolerance = 1e-8;             // A step that changes no weight by more is the last.
    Parameters parameters{};
    Slope slope = slope_at(parameters, files, config.ridge);
    while (result.iterations < most_iterations && !result.converged) {
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
        result.converged =
            std::ranges::all_of(*step, [&](double change) { return std::abs(scale * change) <= tolerance; });
    }
    result.train_loss = slope.loss;
    return parameters;
}

std::vector<const PairSampleFile*> files_of(const std::vector<PairSampleFile>& files,
                                            const std::vector<DataSeed>& seeds, const char* part) {
    std::vector<const PairSampleFile*> chosen;
    LabelCounts counts;
    for (const PairSampleFile& file : files) {
        if (file.linked.empty() || !is_of(file.origin, seeds)) continue;
        counts.add(file.linked);
        chosen.push_back(&file);
    }
    require_both_classes(counts, part);
    return chosen;
}

Scores scores_of(const Parameters& parameters, const PairSampleFile& file) {
    Scores scores;
    for (const prediction::PairFeatures& features : file.features)
        scores.logits.push_back(logit_of(parameters, features));
    scores.linked = file.linked;
    return scores;
}

}  // namespace

LogisticResult train_logistic(const std::vector<PairSampleFile>& files, const LogisticConfig& config) {
    LogisticResult result;
    const Origins origins = origins_of(files);
    result.seeds = split_files(
        origins, {.seed = config.seed, .validation = config.validation_share, .test = config.test_share},
        "SCENARIO --samples --net logistic");
    require_alike(origins);
    result.link_radius = link_radii(origins);
    const std::vector<const PairSampleFile*> train = files_of(files, result.seeds.train, "training");
    files_of(files, result.seeds.validation, "validation");
    files_of(files, result.seeds.test, "test");
    for (const PairSampleFile* const file : train)
        result.train_pairs += file->linked.size();
    const Parameters parameters = fit(train, config, result);
    std::ranges::transform(parameters.begin(), parameters.end() - 1, result.weight.begin(),
                           [](double value) { return static_cast<float>(value); });
    result.bias = parameters.back();
    measure(
        origins, [&](std::size_t file) { return scores_of(parameters, files[file]); }, result);
    return result;
}

Identity identity_of(const LogisticConfig& config, const std::string& data_hash) {
    return {{"mode", "logistic"}, {"data_hash", data_hash}, {"configuration", detail::json_from(config)}};
}

nlohmann::ordered_json LogisticResult::facts() const {
    nlohmann::ordered_json json = {{"outcome", converged ? "finished" : "iterations_used_up"},
                                   {"iterations", iterations},
                                   {"final_train_loss_nat", train_loss}};
    for (std::size_t i = 0; i < pair_feature_count; ++i)
        json["weights"][std::string(prediction::pair_feature_names[i])] = weight[i];
    json["bias"] = bias;
    return json;
}

prediction::Weights LogisticResult::weights() const {
    prediction::Weights weights;
    weights.architecture = prediction::logistic_architecture;
    weights.features = prediction::pair_feature_schema();
    weights.tensors = {
        {"weight", {1, static_cast<std::uint32_t>(pair_feature_count)}, {weight.begin(), weight.end()}},
        {"bias", {1}, {static_cast<float>(bias)}}};
    return weights;
}

}  // namespace clearway::training
