#pragma once

#include <memory>

#include "prediction/predictor.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

// The learned repairs. Both are given the same inputs (repair_inputs.hpp), and start from the twins' places.
// Throw core::InputError for a model file that does not fit, or for links of another radius than it was
// trained for.

/// The improved net: messages over predicted-position neighbours of all classes in the receiver's route
/// frame, a motion head, and a pair decoder on corrected distances (repair_net.hpp).
std::unique_ptr<Predictor> make_graphsage(const PredictorContext& context);
/// Throws core::InputError when the weights are no model of it; so does the function below.
void check_graphsage(const Weights& weights);

/// Boosted trees on a pair's own numbers, its ends' and what their neighbours tell (tree_inputs.hpp), trained
/// by `clearway links train gradient_boosting`. They pass no messages. Believed places are those of the
/// twins, or of the kinematics along the route, in which a vehicle that stands stays where it stood
/// (MotionContextBuilder without start at green).
std::unique_ptr<Predictor> make_gradient_boosting(const PredictorContext& context);
void check_gradient_boosting(const Weights& weights);

}  // namespace clearway::prediction
