#pragma once

#include <string>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction {

/// The model in the program for a predictor, from `src/prediction/models/<predictor>.weights` of the tree at
/// build time. Throws core::InputError, listing the available models, when the program carries none for it.
Weights shipped_model(const std::string& predictor);

/// The model in `file`, or the shipped one where it is empty. Throws core::InputError as shipped_model and
/// read_model do, and when it was not trained for links of this radius.
Weights model_of(const std::string& predictor, const std::string& file, double link_radius_m);

/// Names of the predictors for which the program carries a model.
std::vector<std::string> shipped_model_names();

}  // namespace clearway::prediction
