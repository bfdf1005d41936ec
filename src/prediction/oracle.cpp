#include "prediction/oracle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/keyed_series.hpp"
#include "prediction/candidates.hpp"
#include "prediction/kinematic.hpp"

namespace clearway::prediction {
namespace {

/// Mean length of a spell with a wrong link, s: that of the outages in presets B10. Longer where a share
/// close to 1 needs it.
double spell_s(double share) {
    constexpr double usual_s = 10.0;
    return std::max(usual_s, 1.0 / (1.0 - share));
}

class Oracle final : public Predictor {
  public:
    Oracle(const PredictorContext& context, const OracleConfig& config)
        : plain_(make_no_repair(context)),
          config_(config),
          rules_(context.rules),
          reach_{.radius_m = candidate_reach_m(context.rules),
                 .automated_automated = context.rules.automated_automated,
                 .emergency_emergency = context.rules.emergency_emergency},
          lost_(context.random, core::Purpose::spoiled_link,
                {1.0, lost_share(config), spell_s(lost_share(config))}),
          false_(context.random, core::Purpose::false_link,
                 {1.0, config.false_links, spell_s(config.false_links)}) {}

    std::string_view name() const override { return oracle_name; }
    void predict(const traffic::Observation& observation, traffic::BelievedGraph& belief,
                 Want want) override {
        plain_->predict(observation, belief, want);
        if (want == Want::places || (config_.links_kept == 1.0 && config_.false_links == 0.0)) return;
        spoil(belief);
    }
    CandidateScores scores() const override { return plain_->scores(); }

  private:
    /// A share of 1 is no chain; `is_kept` treats it by itself.
    static double lost_share(const OracleConfig& config) {
        return config.links_kept == 0.0 ? 0.0 : 1.0 - config.links_kept;
    }

    void spoil(traffic::BelievedGraph& belief) {
        x_m_.clear();
        y_m_.clear();
        classes_.clear();
        for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
            x_m_.push_back(vehicle.state.x_m);
            y_m_.push_back(vehicle.state.y_m);
            classes_.push_back(vehicle.vehicle_class);
        }
        builder_.build({x_m_, y_m_, classes_}, reach_, near_);
        const auto second = static_cast<std::uint64_t>(std::floor(belief.time.value));
        belief.links.clear();
        belief.first_link.assign(1, 0);
        for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
            const auto neighbours = near_.neighbours_of(row);
            const auto distances_m = near_.distances_of(row);
            for (std::size_t at = 0; at < neighbours.size(); ++at) {
                const std::uint64_t pair = core::pair_subject(belief.vehicles[row].key.value,
                                                              belief.vehicles[neighbours[at]].key.value);
                if (is_believed(pair, second, distances_m[at]))
                    belief.links.push_back({neighbours[at], distances_m[at], 1.0F});
            }
            belief.first_link.push_back(static_cast<std::uint32_t>(belief.links.size()));
        }
    }

    bool is_believed(std::uint64_t pair, std::uint64_t second, float distance_m) const {
        if (distance_m >= static_cast<float>(rules_.radius_m)) return false_.dark(pair, second);
        return config_.links_kept > 0.0 && !lost_.dark(pair, second);
    }

    std::unique_ptr<Predictor> plain_;
    OracleConfig config_;
    graph::LinkRules rules_, reach_;
    core::GilbertElliott lost_, false_;
    graph::ProximityBuilder builder_;
    graph::ProximityGraph near_;
    std::vector<float> x_m_, y_m_;
    std::vector<traffic::VehicleClass> classes_;
};

}  // namespace

std::unique_ptr<Predictor> make_oracle(const PredictorContext& context, const OracleConfig& config) {
    return std::make_unique<Oracle>(context, config);
}

}  // namespace clearway::prediction
