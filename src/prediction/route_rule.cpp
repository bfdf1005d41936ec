#include "prediction/route_rule.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "prediction/detail/pairwise.hpp"
#include "prediction/motion_context.hpp"
#include "roads/route.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

class RouteRule final : public PairwisePredictor {
  public:
    RouteRule(const PredictorContext& context, const RouteRuleConfig& config)
        : PairwisePredictor(context),
          config_(config),
          roads_(context.network, context.rules,
                 {static_cast<float>(config.start_acceleration_mps2),
                  static_cast<float>(config.start_wave_mps)}) {}
    std::string_view name() const override { return "route_rule"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        roads_.build(observation(), scene, ahead_);
        believe_ahead(scene.tracks, ahead_, beliefs, [&](const MotionContext& ahead) {
            return Moved{ahead.displacement_m,
                         route_rule_sigma_m(ahead.sigma_m, scene.tracks.age_s[ahead.row], config_),
                         ahead.has_left};
        });
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_by_place(scene, beliefs, probabilities);
    }

    RouteRuleConfig config_;
    MotionContextBuilder roads_;
    std::vector<MotionContext> ahead_;
};

}  // namespace

float route_rule_sigma_m(float sensor_sigma_m, float age_s, const RouteRuleConfig& config) {
    if (age_s <= 0.0F) return sensor_sigma_m;
    const float grown_m =
        static_cast<float>(config.first_sigma_m) +
        static_cast<float>(config.growth_m) * std::pow(age_s, static_cast<float>(config.growth_power));
    return std::hypot(sensor_sigma_m, std::min(static_cast<float>(config.most_sigma_m), grown_m));
}

std::unique_ptr<Predictor> make_route_rule(const PredictorContext& context, const RouteRuleConfig& config) {
    return std::make_unique<RouteRule>(context, config);
}

}  // namespace clearway::prediction
