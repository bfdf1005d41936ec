#pragma once

#include <memory>

#include "prediction/predictor.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// Boosted trees on a pair's own numbers, its ends' and what their neighbours tell (tree_inputs.hpp), trained
/// by `clearway train gradient_boosting`. They get what the improved net gets, and pass no messages. Believed
/// places are those of the kinematics along the route, in which a vehicle that stands stays where it stood
/// (MotionContextBuilder without start at green). Throws core::InputError for a model file that does not fit,
/// and for a link radius other than 50 m.
std::unique_ptr<Predictor> make_gradient_boosting(const PredictorContext& context);
/// Throws core::InputError when the weights are no such model.
void check_gradient_boosting(const Weights& weights);

}  // namespace clearway::prediction
