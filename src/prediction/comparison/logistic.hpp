#pragma once

#include <memory>

#include "prediction/comparison/pair_features.hpp"
#include "prediction/predictor.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// Logistic regression as a weights file: tensors `weight` {1, features} and `bias` {1} of this architecture,
/// on `pair_feature_schema()`.
inline constexpr const char* logistic_architecture = "logistic_pairs";

/// Logistic regression on pair features, trained by `clearway links train logistic`: P = 1 / (1 +
/// exp(-(weight . features + bias))). Believed positions are those of dead reckoning. Throws core::InputError
/// for a model file that does not fit.
std::unique_ptr<Predictor> make_logistic(const PredictorContext& context);
/// Throws core::InputError when the weights are no such model.
void check_logistic(const Weights& weights);

}  // namespace clearway::prediction
