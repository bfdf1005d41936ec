#include "prediction/learned.hpp"

#include <string>

#include "prediction/detail/pairwise.hpp"
#include "prediction/features.hpp"
#include "prediction/graphsage.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/shipped_models.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

/// The published schema that a model file names; otherwise the net's constructor explains the mismatch.
FeatureSchema published_schema_of(const Weights& weights) {
    const FeatureSchema attributes = as_published_attributes_schema();
    return weights.features.name == attributes.name ? attributes : as_published_position_schema();
}

class GraphSageAsPublished final : public PairwisePredictor {
  public:
    GraphSageAsPublished(const PredictorContext& context, const Weights& weights)
        : PairwisePredictor(context), schema_(published_schema_of(weights)), net_(weights, schema_) {}
    std::string_view name() const override { return "graphsage_as_published"; }

  private:
    void score(const Scene& scene, const std::vector<RowBelief>&,
               std::vector<float>& probabilities) override {
        if (scene.candidates.size() == 0) return;
        as_published_features(scene.tracks, schema_, network(), features_);
        sources_.clear();
        targets_.clear();
        for (const RowPair pair : scene.candidates.rows) {
            sources_.push_back(pair.left);
            targets_.push_back(pair.right);
        }
        message_graph_from(sources_, targets_, scene.tracks.size(), messages_);
        net_.logits(features_, messages_, scene.candidates.rows, logits_);
        for (std::size_t at = 0; at < probabilities.size(); ++at) {
            probabilities[at] = probability_from_logit(logits_[at]);
        }
    }

    FeatureSchema schema_;
    GraphSageNet net_;
    MessageGraph messages_;
    std::vector<std::uint32_t> sources_, targets_;
    std::vector<float> features_, logits_;
};

class GraphSageCorrected final : public PairwisePredictor {
  public:
    GraphSageCorrected(const PredictorContext& context, const Weights& weights)
        : PairwisePredictor(context), net_(weights, corrected_schema()) {}
    std::string_view name() const override { return "graphsage_corrected"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        detail::believe_dead_reckoned(scene.tracks, beliefs);
    }
    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        if (scene.candidates.size() == 0) return;
        corrected_features(scene.tracks, features_);
        observed_messages_.build(scene, rules(), messages_);
        net_.logits(features_, messages_, scene.candidates.rows, logits_);
        for (std::size_t at = 0; at < probabilities.size(); ++at) {
            const RowPair pair = scene.candidates.rows[at];
            const bool in_reach = scene.candidates.dead_reckoned_m[at] < corrected_reach_m;
            const bool present = beliefs[pair.left].present && beliefs[pair.right].present;
            probabilities[at] = in_reach && present ? probability_from_logit(logits_[at]) : 0.0F;
        }
    }

    GraphSageNet net_;
    ObservedMessages observed_messages_;
    MessageGraph messages_;
    std::vector<float> features_, logits_;
};

}  // namespace

std::unique_ptr<Predictor> make_graphsage_as_published(const PredictorContext& context) {
    return std::make_unique<GraphSageAsPublished>(context,
                                                  model_of("graphsage_as_published", context.model_file));
}
void check_graphsage_as_published(const Weights& weights) {
    const GraphSageNet net(weights, published_schema_of(weights));
}
std::unique_ptr<Predictor> make_graphsage_corrected(const PredictorContext& context) {
    return std::make_unique<GraphSageCorrected>(context, model_of("graphsage_corrected", context.model_file));
}
void check_graphsage_corrected(const Weights& weights) {
    const GraphSageNet net(weights, corrected_schema());
}

}  // namespace clearway::prediction
