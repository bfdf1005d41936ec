#pragma once

#include <memory>
#include <string>

#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// A predictor that is a class in Python, or a TorchScript module: it gets vehicles, known links and
/// candidates as arrays in shared memory and answers with a probability for each candidate. Vehicles are
/// believed where dead reckoning puts them. Throws core::InputError when the file has changed,
/// python::PartError when it cannot be loaded; `predict` throws python::PartError with the traceback of an
/// exception.
std::unique_ptr<Predictor> make_python_predictor(const PredictorContext& context, const std::string& word);

}  // namespace clearway::prediction
