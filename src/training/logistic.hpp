#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "metrics/link_quality.hpp"
#include "samples/pair_samples.hpp"
#include "training/output_folder.hpp"
#include "training/seeds.hpp"

namespace clearway::training {

struct LogisticConfig {
    double ridge = 1e-6;
    std::uint32_t most_iterations = 50;
    double tolerance = 1e-8;
    double validation_share = 0.2;
    double test_share = 0.2;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using C = LogisticConfig;
        return std::make_tuple(
            core::Field{"ridge", "1", &C::ridge, 0.0, 1e6,
                        "Weight of half the squared length of the weights, beside the mean loss",
                        "keeps the solution finite where classes can be separated"},
            core::Field{"most_iterations", "1", &C::most_iterations, 1.0, 1e6, "Newton steps at most",
                        "about 10 are needed"},
            core::Field{"tolerance", "1", &C::tolerance, 0.0, 1.0,
                        "A step that changes no weight by more ends the training", "assumed"},
            core::Field{"validation_share", "1", &C::validation_share, 0.01, 0.8,
                        "Share of the seeds that choose the threshold", "as the net's"},
            core::Field{"test_share", "1", &C::test_share, 0.01, 0.8, "Share of the seeds that only measure",
                        "as the net's"},
            core::Field{"seed", "1", &C::seed, 0.0, 9e15, "Seed of the split", "assumed"});
    }
};

struct LogisticGroup {
    std::string scenario;  ///< Empty: all.
    std::string failure;   ///< Empty: all.
    metrics::LinkQuality quality;
};

struct LogisticResult {
    prediction::PairFeatures weight{};
    double bias = 0.0;
    std::uint32_t iterations = 0;
    bool converged = false;
    double train_loss = 0.0;  ///< Mean log loss of the training seeds, nat.
    SeedSplit seeds;
    std::uint64_t train_pairs = 0;
    double threshold = 0.5;             ///< Greatest F1 on the validation seeds.
    double link_radius_m = 50.0;        ///< Of the data.
    std::vector<LogisticGroup> groups;  ///< On the test seeds: all first, then by scenario and failure.
};

/// Logistic regression on pair features by Newton's method (iteratively reweighted least squares; Hastie,
/// Tibshirani, Friedman 2009, "The Elements of Statistical Learning", 4.4.1) with a small ridge. Split by
/// seed as for the net. Deterministic. Throws core::InputError for fewer than three seeds, files with
/// different link radii, or a part of the split with pairs of only one class.
LogisticResult train_logistic(const std::vector<samples::PairSampleFile>& files,
                              const LogisticConfig& config);

/// Identifies this training.
Identity identity_of(const LogisticConfig& config, const std::string& data_hash);

/// The summary that `--json` prints and `summary.json` holds.
nlohmann::ordered_json summary_of(const LogisticResult& result, const LogisticConfig& config,
                                  const std::filesystem::path& data, const std::string& data_hash);

/// Writes summary.json and logistic.weights, each whole or not at all. Throws core::EnvironmentError.
void write_outputs(const std::filesystem::path& folder, const LogisticResult& result,
                   const nlohmann::ordered_json& summary);

}  // namespace clearway::training
