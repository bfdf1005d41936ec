#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "graph/proximity.hpp"
#include "roads/network.hpp"
#include "traffic/belief.hpp"
#include "traffic/observation.hpp"

namespace clearway::prediction {

/// Repair: from what was reported to what is believed. Called at every step; the observation changes its
/// content at report rounds and its ages between them. Deterministic; keeps state and buffers; one thread.
/// Never sees the truth.
class Predictor {
  public:
    Predictor() = default;
    Predictor(const Predictor&) = delete;
    Predictor& operator=(const Predictor&) = delete;
    virtual ~Predictor() = default;

    virtual std::string_view name() const = 0;
    /// Fills `belief` (buffers reused): vehicles ordered by key, links by the candidate rule common to all
    /// predictors, each with its probability, own states, signals and roster copied from the observation.
    virtual void predict(const traffic::Observation& observation, traffic::BelievedGraph& belief) = 0;
};

/// What a predictor needs beside the observation. References outlive the predictor.
struct PredictorContext {
    const roads::Network& network;
    graph::LinkRules rules;
    std::string model_file;  ///< For the learned ones; empty: the model shipped with the program.
};

/// Names that `make_predictor` takes, in the order of the documentation.
std::vector<std::string> predictor_names();

/// Throws core::InputError for an unknown name (naming the nearest) or an unreadable or unfit model file.
std::unique_ptr<Predictor> make_predictor(const std::string& name, const PredictorContext& context);

}  // namespace clearway::prediction
