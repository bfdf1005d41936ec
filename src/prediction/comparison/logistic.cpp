#include "prediction/comparison/logistic.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "prediction/detail/pairwise.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/shipped_models.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

class Logistic final : public PairwisePredictor {
  public:
    Logistic(const PredictorContext& context, const Weights& weights) : PairwisePredictor(context) {
        check_logistic(weights);
        std::ranges::copy(weights.tensor("weight", {1, pair_feature_count}).values, weight_.begin());
        bias_ = weights.tensor("bias", {1}).values[0];
    }
    std::string_view name() const override { return "logistic"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        detail::believe_dead_reckoned(scene.tracks, beliefs);
    }
    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_present(scene, beliefs, probabilities, [&](std::size_t at) {
            const PairFeatures features = pair_features(scene, at, static_cast<float>(rules().radius_m));
            float logit = bias_;
            for (std::size_t i = 0; i < pair_feature_count; ++i)
                logit += weight_[i] * features[i];
            return probability_from_logit(logit);
        });
    }

    PairFeatures weight_{};
    float bias_ = 0.0F;
};

}  // namespace

void check_logistic(const Weights& weights) {
    weights.require(logistic_architecture, pair_feature_schema());
    weights.tensor("weight", {1, pair_feature_count});
    weights.tensor("bias", {1});
    weights.require_tensors(2);
}

std::unique_ptr<Predictor> make_logistic(const PredictorContext& context) {
    return std::make_unique<Logistic>(context,
                                      model_of("logistic", context.model_file, context.rules.radius_m));
}

}  // namespace clearway::prediction
