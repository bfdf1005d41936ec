#include "prediction/planar.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "prediction/detail/pairwise.hpp"
#include "prediction/disc_probability.hpp"
#include "prediction/motion_filter.hpp"

namespace clearway::prediction {
namespace {

using detail::PairwisePredictor;
using detail::RowBelief;

/// Below this speed a velocity has no direction worth reporting, m/s.
constexpr float least_directed_mps = 0.1F;
/// Reports are at least 0.1 s apart; times closer than this are equal, s.
constexpr double same_moment_s = 0.01;

class HeadingReckoning final : public PairwisePredictor {
  public:
    HeadingReckoning(const PredictorContext& context, const DeadReckoningConfig& config)
        : PairwisePredictor(context), config_(config) {}
    std::string_view name() const override { return "dead_reckoning_heading"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        const Tracks& tracks = scene.tracks;
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            RowBelief& belief = beliefs[row];
            const traffic::MotionState& last = tracks.last[row];
            const float moved_m = last.speed_mps * tracks.age_s[row];
            belief.state = tracks.state[row];
            belief.state.x_m = last.x_m + std::cos(last.heading_rad) * moved_m;
            belief.state.y_m = last.y_m + std::sin(last.heading_rad) * moved_m;
            belief.state.heading_rad = last.heading_rad;
            belief.sigma_m = dead_reckoned_sigma_m(tracks.sensor_sigma_m[row], tracks.age_s[row], config_);
            belief.present = !tracks.has_left(row);
        }
    }
    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_by_place(scene, beliefs, probabilities);
    }

    DeadReckoningConfig config_;
};

/// The filter of one vehicle, and the time of the last report it took in.
struct Filter {
    core::VehicleKey key;
    double measured_s = 0.0;
    MotionFilter motion;
};

class Kalman final : public PairwisePredictor {
  public:
    Kalman(const PredictorContext& context, const KalmanConfig& config)
        : PairwisePredictor(context),
          noise_{static_cast<float>(config.along_psd), static_cast<float>(config.across_psd),
                 static_cast<float>(config.speed_sigma_mps * config.speed_sigma_mps)} {}
    std::string_view name() const override { return "kalman"; }

  private:
    void believe(const Scene& scene, std::vector<RowBelief>& beliefs) override {
        follow(scene.tracks);
        const Tracks& tracks = scene.tracks;
        now_ = filters_;
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            MotionFilter& now = now_[row].motion;
            if (tracks.age_s[row] > 0.0F)
                elapse(tracks.age_s[row], tracks.last[row].heading_rad, noise_, now);
            RowBelief& belief = beliefs[row];
            belief.state = tracks.state[row];
            belief.state.x_m = now.mean[0];
            belief.state.y_m = now.mean[1];
            belief.state.speed_mps = std::hypot(now.mean[2], now.mean[3]);
            if (belief.state.speed_mps > least_directed_mps)
                belief.state.heading_rad = std::atan2(now.mean[3], now.mean[2]);
            belief.sigma_m = sigma_along(now, tracks.last[row].heading_rad);
            belief.present = !tracks.has_left(row);
        }
    }

    static float sigma_along(const MotionFilter& filter, float heading_rad) {
        const float cosine = std::cos(heading_rad);
        const float sine = std::sin(heading_rad);
        const auto& p = filter.covariance;
        return std::sqrt(std::max(
            0.0F, cosine * cosine * p[0][0] + 2.0F * cosine * sine * p[0][1] + sine * sine * p[1][1]));
    }

    /// Updates the filters to the newest report of each vehicle, one filter per row. Both lists are ordered
    /// by key.
    void follow(const Tracks& tracks) {
        next_.clear();
        auto old = filters_.begin();
        for (std::size_t row = 0; row < tracks.size(); ++row) {
            while (old != filters_.end() && old->key < tracks.key[row]) {
                ++old;
            }
            const bool known = old != filters_.end() && old->key == tracks.key[row];
            next_.push_back(known ? *old : Filter{.key = tracks.key[row], .measured_s = -1.0, .motion = {}});
            take_report(tracks, row, next_.back());
        }
        std::swap(filters_, next_);
    }

    void take_report(const Tracks& tracks, std::size_t row, Filter& filter) const {
        const double measured_s = tracks.time_s - tracks.age_s[row];
        const double elapsed_s = measured_s - filter.measured_s;
        if (filter.measured_s >= 0.0 && std::abs(elapsed_s) < same_moment_s) return;
        const traffic::MotionState& last = tracks.last[row];
        const float sigma_m = tracks.sensor_sigma_m[row];
        if (filter.measured_s < 0.0 || elapsed_s < 0.0) {
            start(last, sigma_m, noise_, filter.motion);
        } else {
            prediction::follow(last, sigma_m, static_cast<float>(elapsed_s), noise_, filter.motion);
        }
        filter.measured_s = measured_s;
    }

    void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
               std::vector<float>& probabilities) override {
        score_present(scene, beliefs, probabilities, [&](std::size_t at) {
            const RowPair pair = scene.candidates.rows[at];
            const MotionFilter& left = now_[pair.left].motion;
            const MotionFilter& right = now_[pair.right].motion;
            return probability_in_disc(static_cast<float>(rules().radius_m),
                                       {right.mean[0] - left.mean[0], right.mean[1] - left.mean[1],
                                        left.covariance[0][0] + right.covariance[0][0],
                                        left.covariance[0][1] + right.covariance[0][1],
                                        left.covariance[1][1] + right.covariance[1][1]});
        });
    }

    FilterNoise noise_;
    std::vector<Filter> filters_, next_, now_;
};

}  // namespace

std::unique_ptr<Predictor> make_dead_reckoning_heading(const PredictorContext& context,
                                                       const DeadReckoningConfig& config) {
    return std::make_unique<HeadingReckoning>(context, config);
}
std::unique_ptr<Predictor> make_kalman(const PredictorContext& context, const KalmanConfig& config) {
    return std::make_unique<Kalman>(context, config);
}

}  // namespace clearway::prediction
