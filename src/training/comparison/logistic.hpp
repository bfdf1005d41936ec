#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "samples/pair_samples.hpp"
#include "training/output_folder.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

struct LogisticConfig {
    double ridge = 1e-6;
    double validation_share = 0.2;
    double test_share = 0.2;
    std::uint64_t seed = 1;

    static constexpr void fields(const auto& table) {
        using C = LogisticConfig;
        table(core::Field{"ridge", "1", &C::ridge, 0.0, 1e6,
                          "Weight of half the squared length of the weights, beside the mean loss",
                          "keeps the solution finite where classes can be separated"},
              core::Field{"validation_share", "1", &C::validation_share, 0.01, 0.8,
                          "Share of the seeds that choose the threshold", "as the net's"},
              core::Field{"test_share", "1", &C::test_share, 0.01, 0.8,
                          "Share of the seeds that only measure", "as the net's"},
              core::Field{"seed", "1", &C::seed, 0.0, 9e15, "Seed of the split", "assumed"});
    }
};

struct LogisticResult : TrainingResult {
    nlohmann::ordered_json facts() const override;
    prediction::Weights weights() const override;

    prediction::PairFeatures weight{};
    double bias = 0.0;
    std::uint32_t iterations = 0;
    bool converged = false;
    double train_loss = 0.0;  ///< Mean log loss of the training seeds, nat.
};

/// Logistic regression on pair features by Newton's method (iteratively reweighted least squares; Hastie,
/// Tibshirani, Friedman 2009, "The Elements of Statistical Learning", 4.4.1) with a small ridge. Split by
/// seed as for the net. Deterministic. Throws core::InputError for fewer than three seeds, files with
/// different link radii, or a part of the split with pairs of only one class.
LogisticResult train_logistic(const std::vector<samples::PairSampleFile>& files,
                              const LogisticConfig& config);

/// Identifies this training.
Identity identity_of(const LogisticConfig& config, const std::string& data_hash);

}  // namespace clearway::training
