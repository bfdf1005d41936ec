#pragma once

#include <memory>
#include <string>

#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// Settings of a predictor in Python: those that all predictors share, and keyword arguments of its class.
struct PartedSettings {
    core::Settings shared, own;
};
/// `prediction::check_settings` checks the shared ones alone; Python checks its own.
PartedSettings parted_settings(const core::Settings& settings);

/// A predictor that is a class in Python, or a TorchScript module: it gets vehicles, known links and
/// candidates as arrays in shared memory and answers with a probability for each candidate. Vehicles are
/// believed where dead reckoning puts them. Throws core::InputError when the file has changed,
/// core::InputError for unfit settings that all predictors share, python::PartError when it cannot be
/// loaded; `predict` throws python::PartError with the traceback of an
/// exception.
std::unique_ptr<Predictor> make_python_predictor(PredictorContext context, const std::string& word,
                                                 const core::Settings& settings);

}  // namespace clearway::prediction
