#pragma once

#include <memory>

#include "prediction/predictor.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// The dissertation's net, as it was used: on coordinates where vehicles were last seen (2 or 5 inputs, as
/// the model file says), messages along the listed pairs themselves, from the first of a pair to the second,
/// as chapter 5.2 passes `edge_index`. Its logits hardly depend on distance (AUC about 0.5 in our
/// measurements); it is kept to show that.
std::unique_ptr<Predictor> make_graphsage_as_published(const PredictorContext& context);

/// Throws core::InputError when the weights are no model of it; so do the functions below.
void check_graphsage_as_published(const Weights& weights);

/// The same architecture with what was wrong put right: inputs in which distance can be measured
/// (features.hpp, `corrected`), messages along observed links only, trained with negatives from the
/// candidates. Believed states are dead-reckoned; pairs out of the kernel's reach have probability 0.
std::unique_ptr<Predictor> make_graphsage_corrected(const PredictorContext& context);
void check_graphsage_corrected(const Weights& weights);

/// As make_graphsage_corrected, with GCN or GAT in the place of GraphSAGE's convolution
/// (dissertation_net.hpp).
std::unique_ptr<Predictor> make_gcn(const PredictorContext& context);
void check_gcn(const Weights& weights);
std::unique_ptr<Predictor> make_gat(const PredictorContext& context);
void check_gat(const Weights& weights);

}  // namespace clearway::prediction
