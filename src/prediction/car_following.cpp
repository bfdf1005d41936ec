#include "prediction/car_following.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "prediction/detail/pairwise.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/twin_traffic.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

class CarFollowing final : public PairwisePredictor {
  public:
    CarFollowing(const PredictorContext& context, const CarFollowingConfig& config)
        : PairwisePredictor(context), config_(config), twins_(context.network, config) {}
    std::string_view name() const override { return "car_following"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        const Tracks& tracks = scene.tracks;
        twins_.follow(observation(), tracks);
        sensor_sigma_m_.resize(tracks.size());
        for (std::uint32_t row = 0; row < tracks.size(); ++row) {
            const bool as_reported = tracks.age_s[row] <= 0.0F && tracks.sensor_sigma_m[row] == 0.0F;
            const bool drives = !as_reported && twins_.is_twin(row);
            sensor_sigma_m_[row] = drives ? twins_.seen_sigma_m(row) : tracks.sensor_sigma_m[row];
            RowBelief& belief = beliefs[row];
            belief.state = drives ? twins_.state(row) : tracks.state[row];
            belief.sigma_m = std::hypot(
                sensor_sigma_m_[row], deviation_of_spread * twin_spread_m(tracks.age_s[row], 0.0F, config_));
            belief.present = tracks.exits_known || !(drives ? twins_.at_end(row) : tracks.has_left(row));
        }
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        const Tracks& tracks = scene.tracks;
        const auto within_m = static_cast<float>(rules().radius_m + config_.bias_m);
        score_present(scene, beliefs, probabilities, [&](std::size_t at) {
            const auto [left, right] = scene.candidates.rows[at];
            const float distance_m = std::hypot(beliefs[left].state.x_m - beliefs[right].state.x_m,
                                                beliefs[left].state.y_m - beliefs[right].state.y_m);
            const float sensors_m =
                std::hypot(sensor_sigma_m_[left], sensor_sigma_m_[right]) / deviation_of_spread;
            return probability_from_logit(
                twin_link_logit(within_m - distance_m, sensors_m,
                                twin_spread_m(tracks.age_s[left], tracks.age_s[right], config_), config_));
        });
    }

    CarFollowingConfig config_;
    TwinTraffic twins_;
    std::vector<float> sensor_sigma_m_;
};

}  // namespace

float twin_growth(float age_s, const CarFollowingConfig& config) {
    return std::pow(std::max(0.0F, age_s), static_cast<float>(config.growth_power));
}

float twin_spread_of(float one_growth, float other_growth, const CarFollowingConfig& config) {
    return static_cast<float>(config.older_growth_m) * std::max(one_growth, other_growth) +
           static_cast<float>(config.younger_growth_m) * std::min(one_growth, other_growth);
}

float twin_spread_m(float one_age_s, float other_age_s, const CarFollowingConfig& config) {
    return twin_spread_of(twin_growth(one_age_s, config), twin_growth(other_age_s, config), config);
}

float twin_link_logit(float room_m, float sensor_spread_m, float twin_spread_m,
                      const CarFollowingConfig& config) {
    constexpr float sure = std::numeric_limits<float>::infinity();
    const float by_sensors = sensor_spread_m > 0.0F ? room_m / sensor_spread_m : 0.0F;
    const float by_motion = twin_spread_m > 0.0F
                                ? static_cast<float>(config.tail_power) * std::asinh(room_m / twin_spread_m)
                                : 0.0F;
    if (sensor_spread_m <= 0.0F && twin_spread_m <= 0.0F) return room_m > 0.0F ? sure : -sure;
    if (sensor_spread_m <= 0.0F) return by_motion;
    if (twin_spread_m <= 0.0F) return by_sensors;
    const float both = std::hypot(by_sensors, by_motion);
    return both > 0.0F ? by_sensors * std::abs(by_motion) / both : 0.0F;
}

std::unique_ptr<Predictor> make_car_following(const PredictorContext& context,
                                              const CarFollowingConfig& config) {
    return std::make_unique<CarFollowing>(context, config);
}

}  // namespace clearway::prediction
