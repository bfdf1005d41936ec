#include "prediction/kinematic.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

#include "prediction/detail/pairwise.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

class NoRepair final : public PairwisePredictor {
  public:
    using PairwisePredictor::PairwisePredictor;
    std::string_view name() const override { return "none"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        const Tracks& tracks = scene.tracks;
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            beliefs[row] = {tracks.last[row], tracks.sensor_sigma_m[row],
                            tracks.freshness[row] == traffic::Freshness::fresh};
        }
    }
    /// Fresh reports with a stated error are candidates: linked by the measured distance as it stands.
    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_present(scene, beliefs, probabilities, [&](std::size_t at) {
            return probability_within(static_cast<float>(rules().radius_m), scene.candidates.last_seen_m[at],
                                      0.0F);
        });
    }
};

class LastSeen final : public PairwisePredictor {
  public:
    LastSeen(const PredictorContext& context, const LastSeenConfig& config)
        : PairwisePredictor(context), config_(config) {}
    std::string_view name() const override { return "last_seen"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        detail::believe_last_seen(scene.tracks, beliefs, config_);
    }
    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_by_distance(scene, beliefs, scene.candidates.last_seen_m, probabilities);
    }

    LastSeenConfig config_;
};

class DeadReckoning final : public PairwisePredictor {
  public:
    DeadReckoning(const PredictorContext& context, const DeadReckoningConfig& config)
        : PairwisePredictor(context), config_(config) {}
    std::string_view name() const override { return "dead_reckoning"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        detail::believe_dead_reckoned(scene.tracks, beliefs, config_);
    }
    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_by_distance(scene, beliefs, scene.candidates.dead_reckoned_m, probabilities);
    }

    DeadReckoningConfig config_;
};

}  // namespace

namespace detail {

void believe_last_seen(const Tracks& tracks, std::vector<RowBelief>& beliefs, const LastSeenConfig& config) {
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        beliefs[row] = {
            tracks.last[row],
            held_sigma_m(tracks.sensor_sigma_m[row], tracks.last[row].speed_mps, tracks.age_s[row], config),
            true};
    }
}

void believe_dead_reckoned(const Tracks& tracks, std::vector<RowBelief>& beliefs,
                           const DeadReckoningConfig& config) {
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        beliefs[row] = {tracks.state[row],
                        dead_reckoned_sigma_m(tracks.sensor_sigma_m[row], tracks.age_s[row], config),
                        !tracks.has_left(row)};
    }
}

}  // namespace detail

float held_sigma_m(float sensor_sigma_m, float speed_mps, float age_s, const LastSeenConfig& config) {
    return std::hypot(sensor_sigma_m, (speed_mps + static_cast<float>(config.start_speed_mps)) * age_s);
}

float dead_reckoned_sigma_m(float sensor_sigma_m, float age_s, const DeadReckoningConfig& config) {
    return std::hypot(sensor_sigma_m, static_cast<float>(config.speed_change_mps) * age_s);
}

float probability_within(float radius_m, float distance_m, float sigma_m) {
    if (sigma_m <= 0.0F) return distance_m < radius_m ? 1.0F : 0.0F;
    const float score = (radius_m - distance_m) / sigma_m;
    return 0.5F * std::erfc(-score / std::numbers::sqrt2_v<float>);
}

std::unique_ptr<Predictor> make_no_repair(const PredictorContext& context) {
    return std::make_unique<NoRepair>(context);
}
std::unique_ptr<Predictor> make_last_seen(const PredictorContext& context, const LastSeenConfig& config) {
    return std::make_unique<LastSeen>(context, config);
}
std::unique_ptr<Predictor> make_dead_reckoning(const PredictorContext& context,
                                               const DeadReckoningConfig& config) {
    return std::make_unique<DeadReckoning>(context, config);
}

}  // namespace clearway::prediction
