#include "prediction/learned.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "prediction/boosted_trees.hpp"
#include "prediction/car_following.hpp"
#include "prediction/detail/pairwise.hpp"
#include "prediction/repair_net.hpp"
#include "prediction/route_rule.hpp"
#include "prediction/shipped_models.hpp"
#include "prediction/tree_inputs.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

constexpr const char* net_name = "graphsage";
constexpr const char* trees_name = "gradient_boosting";

/// Whether a vehicle is past the end of its route where exits are not known: its twin, or the rule where it
/// has none.
bool has_left(const Scene& scene, const MotionContext& ahead) {
    if (!ahead.drives) return ahead.has_left;
    return !scene.tracks.exits_known && scene.twins->at_end(ahead.row);
}

/// Standard deviation of the place of a twin, or of the route rule's where there is none.
float believed_sigma_m(const Tracks& tracks, const MotionContext& ahead) {
    const float age_s = tracks.age_s[ahead.row];
    if (!ahead.drives) return route_rule_sigma_m(ahead.sigma_m, age_s, RouteRuleConfig{});
    return std::hypot(ahead.sigma_m, deviation_of_spread * twin_spread_m(age_s, 0.0F, CarFollowingConfig{}));
}

class LearnedPredictor : public PairwisePredictor {
  public:
    explicit LearnedPredictor(const PredictorContext& context)
        : PairwisePredictor(context, Needs::twins), builder_(context.network, context.rules) {}

  protected:
    const RepairInputs& inputs() const { return inputs_; }

  private:
    /// Called once a scene that has vehicles which are not known.
    virtual void run() {}
    /// Where entry `at` of the vehicles that are not known is believed to be; whether it has left is not
    /// asked.
    virtual Moved moved(const Tracks& tracks, const MotionContext& ahead, std::size_t at) const = 0;

    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) final {
        builder_.build(observation(), scene, inputs_);
        if (!builder_.ahead().empty()) run();
        std::size_t at = 0;
        believe_ahead(scene.tracks, builder_.ahead(), beliefs, [&](const MotionContext& ahead) {
            Moved to = moved(scene.tracks, ahead, at++);
            to.has_left = has_left(scene, ahead);
            return to;
        });
    }

    RepairInputBuilder builder_;
    RepairInputs inputs_;
};

class GraphSage final : public LearnedPredictor {
  public:
    GraphSage(const PredictorContext& context, const Weights& weights)
        : LearnedPredictor(context), net_(weights) {}
    std::string_view name() const override { return net_name; }

  private:
    void run() override { net_.run(inputs(), logits_, motions_); }

    Moved moved(const Tracks&, const MotionContext&, std::size_t at) const override {
        // The standard deviation of a Laplace density is this times its mean absolute error.
        constexpr float root_two = 1.41421356F;
        return {motions_[at].displacement_m, root_two * motions_[at].sigma_m};
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_present(scene, beliefs, probabilities,
                      [&](std::size_t at) { return probability_from_logit(logits_[at]); });
    }

    RepairNet net_;
    std::vector<float> logits_;
    std::vector<BelievedMotion> motions_;
};

class GradientBoosting final : public LearnedPredictor {
  public:
    GradientBoosting(const PredictorContext& context, const Weights& weights)
        : LearnedPredictor(context), trees_(weights, tree_schema()) {}
    std::string_view name() const override { return trees_name; }

  private:
    Moved moved(const Tracks& tracks, const MotionContext& ahead, std::size_t) const override {
        return {ahead.believed_m(), believed_sigma_m(tracks, ahead)};
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_present(scene, beliefs, probabilities, [&](std::size_t at) {
            write_tree_inputs(inputs(), at, row_);
            return probability_from_logit(trees_.sum(row_));
        });
    }

    BoostedTrees trees_;
    std::array<float, tree_width> row_{};
};

}  // namespace

std::unique_ptr<Predictor> make_graphsage(const PredictorContext& context) {
    return std::make_unique<GraphSage>(context,
                                       model_of(net_name, context.model_file, context.rules.radius_m));
}
void check_graphsage(const Weights& weights) {
    const RepairNet net(weights);
}

std::unique_ptr<Predictor> make_gradient_boosting(const PredictorContext& context) {
    return std::make_unique<GradientBoosting>(
        context, model_of(trees_name, context.model_file, context.rules.radius_m));
}
void check_gradient_boosting(const Weights& weights) {
    const BoostedTrees trees(weights, tree_schema());
    weights.require_inputs(tree_input_names());
}

}  // namespace clearway::prediction
