#include "prediction/comparison/published_nets.hpp"

#include <string>
#include <string_view>

#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/comparison/features.hpp"
#include "prediction/detail/pairwise.hpp"
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
        : PairwisePredictor(context),
          schema_(published_schema_of(weights)),
          net_(Convolution::sage, weights, schema_) {}
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
    DissertationNet net_;
    MessageGraph messages_;
    std::vector<std::uint32_t> sources_, targets_;
    std::vector<float> features_, logits_;
};

/// A net on the corrected features whose messages take observed links.
class CorrectedNet final : public PairwisePredictor {
  public:
    CorrectedNet(const PredictorContext& context, std::string_view name, Convolution convolution)
        : PairwisePredictor(context),
          name_(name),
          net_(convolution, model_of(std::string(name), context.model_file, context.rules.radius_m),
               corrected_schema()) {}
    std::string_view name() const override { return name_; }

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
        score_present(scene, beliefs, probabilities, [&](std::size_t at) {
            const bool in_reach = scene.candidates.dead_reckoned_m[at] < corrected_reach_m;
            return in_reach ? probability_from_logit(logits_[at]) : 0.0F;
        });
    }

    std::string_view name_;
    DissertationNet net_;
    ObservedMessages observed_messages_;
    MessageGraph messages_;
    std::vector<float> features_, logits_;
};

}  // namespace

std::unique_ptr<Predictor> make_graphsage_as_published(const PredictorContext& context) {
    return std::make_unique<GraphSageAsPublished>(
        context, model_of("graphsage_as_published", context.model_file, context.rules.radius_m));
}
void check_graphsage_as_published(const Weights& weights) {
    const DissertationNet net(Convolution::sage, weights, published_schema_of(weights));
}

std::unique_ptr<Predictor> make_graphsage_corrected(const PredictorContext& context) {
    return std::make_unique<CorrectedNet>(context, "graphsage_corrected", Convolution::sage);
}
void check_graphsage_corrected(const Weights& weights) {
    const DissertationNet net(Convolution::sage, weights, corrected_schema());
}

std::unique_ptr<Predictor> make_gcn(const PredictorContext& context) {
    return std::make_unique<CorrectedNet>(context, "gcn", Convolution::gcn);
}
void check_gcn(const Weights& weights) {
    const DissertationNet net(Convolution::gcn, weights, corrected_schema());
}

std::unique_ptr<Predictor> make_gat(const PredictorContext& context) {
    return std::make_unique<CorrectedNet>(context, "gat", Convolution::gat);
}
void check_gat(const Weights& weights) {
    const DissertationNet net(Convolution::gat, weights, corrected_schema());
}

}  // namespace clearway::prediction
