#include "prediction/gradient_boosting.hpp"

#include <array>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/boosted_trees.hpp"
#include "prediction/detail/pairwise.hpp"
#include "prediction/detail/repair_belief.hpp"
#include "prediction/graphsage.hpp"
#include "prediction/repair_net.hpp"
#include "prediction/route_rule.hpp"
#include "prediction/shipped_models.hpp"
#include "prediction/tree_inputs.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

constexpr const char* own_name = "gradient_boosting";

class GradientBoosting final : public PairwisePredictor {
  public:
    GradientBoosting(const PredictorContext& context, const Weights& weights)
        : PairwisePredictor(context, Needs::twins),
          builder_(context.network, context.rules),
          trees_(weights, tree_schema()) {}
    std::string_view name() const override { return own_name; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        const Tracks& tracks = scene.tracks;
        builder_.build(observation(), scene, inputs_);
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            beliefs[row] = {tracks.state[row], tracks.sensor_sigma_m[row], true};
        }
        for (const MotionContext& ahead : builder_.ahead()) {
            beliefs[ahead.row] = {
                detail::state_after(network(), observation(), tracks, ahead, ahead.believed_m()),
                detail::believed_sigma_m(tracks, ahead), !detail::has_left(scene, ahead)};
        }
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        for (std::size_t at = 0; at < scene.candidates.size(); ++at) {
            const RowPair pair = scene.candidates.rows[at];
            if (!beliefs[pair.left].present || !beliefs[pair.right].present) continue;
            write_tree_inputs(inputs_, at, row_);
            probabilities[at] = probability_from_logit(trees_.sum(row_));
        }
    }

    RepairInputBuilder builder_;
    RepairInputs inputs_;
    BoostedTrees trees_;
    std::array<float, tree_width> row_{};
};

}  // namespace

std::unique_ptr<Predictor> make_gradient_boosting(const PredictorContext& context) {
    return std::make_unique<GradientBoosting>(context,
                                              model_of(own_name, context.model_file, context.rules.radius_m));
}

void check_gradient_boosting(const Weights& weights) {
    const BoostedTrees trees(weights, tree_schema());
    for (const InputNames& names : tree_input_names()) {
        for (const InputNames& kept : weights.inputs) {
            if (kept.name != names.name || kept == names) continue;
            throw core::InputError({weights.source, "was trained on inputs of other names",
                                    fmt::format("those of {} {}", tree_schema().name, tree_schema().version),
                                    "Train the model again"});
        }
    }
}

}  // namespace clearway::prediction
