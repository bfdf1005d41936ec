#pragma once

#include <string>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction {

/// The model in `file` for the predictor: a text of `clearway links train`, or a file of Python's
/// `torch.save(model.state_dict(), file)` of the class that the predictor is for (`graphsage_as_published`
/// and `graphsage_corrected`: the dissertation's GraphSAGENet; `gcn`, `gat`: the same with that convolution).
/// What a state dict leaves unsaid, the features, follows from the predictor and the number of inputs. Throws
/// core::InputError when the file is missing, is neither, or does not fit.
Weights read_model(const std::string& predictor, const std::string& file);

/// Predictors that take a file of `torch.save`.
std::vector<std::string> pth_predictors();

}  // namespace clearway::prediction
