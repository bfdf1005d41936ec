#pragma once

#include <string>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction {

/// The model in the program for a predictor, from `src/prediction/models/<predictor>.weights` of the tree at
/// build time. Throws core::InputError, naming those that there are, when the program carries none for it.
Weights shipped_model(const std::string& predictor);

/// Names of the predictors for which the program carries a model.
std::vector<std::string> shipped_model_names();

}  // namespace clearway::prediction
