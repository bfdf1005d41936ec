#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/detail/pairwise.hpp"
#include "prediction/detail/repair_belief.hpp"
#include "prediction/learned.hpp"
#include "prediction/repair_net.hpp"
#include "prediction/shipped_models.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

/// The standard deviation of a Laplace density is this times its mean absolute error.
constexpr float root_two = 1.41421356F;

class GraphSage final : public PairwisePredictor {
  public:
    GraphSage(const PredictorContext& context, const Weights& weights)
        : PairwisePredictor(context, Needs::twins), builder_(context.network, context.rules), net_(weights) {}
    std::string_view name() const override { return "graphsage"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        const Tracks& tracks = scene.tracks;
        builder_.build(observation(), scene, inputs_);
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            beliefs[row] = {tracks.state[row], tracks.sensor_sigma_m[row], true};
        }
        if (builder_.ahead().empty()) return;
        net_.run(inputs_, logits_, motions_);
        for (std::size_t i = 0; i < builder_.ahead().size(); ++i) {
            const MotionContext& ahead = builder_.ahead()[i];
            const BelievedMotion& motion = motions_[i];
            beliefs[ahead.row] = {
                detail::state_after(network(), observation(), tracks, ahead, motion.displacement_m),
                root_two * motion.sigma_m, !detail::has_left(scene, ahead)};
        }
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        for (std::size_t at = 0; at < scene.candidates.size(); ++at) {
            const RowPair pair = scene.candidates.rows[at];
            if (!beliefs[pair.left].present || !beliefs[pair.right].present) continue;
            probabilities[at] = probability_from_logit(logits_[at]);
        }
    }

    RepairInputBuilder builder_;
    RepairInputs inputs_;
    RepairNet net_;
    std::vector<float> logits_;
    std::vector<BelievedMotion> motions_;
};

}  // namespace

std::unique_ptr<Predictor> make_graphsage(const PredictorContext& context) {
    return std::make_unique<GraphSage>(context,
                                       model_of("graphsage", context.model_file, context.rules.radius_m));
}
void check_graphsage(const Weights& weights) {
    const RepairNet net(weights);
}

}  // namespace clearway::prediction
