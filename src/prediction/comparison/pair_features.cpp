#include "prediction/comparison/pair_features.hpp"

#include <algorithm>
#include <cmath>

#include "prediction/kinematic.hpp"

namespace clearway::prediction {
namespace {

constexpr float longest_m = 200.0F;
constexpr float metres_each = 10.0F;
constexpr float seconds_each = 10.0F;
constexpr float speed_each_mps = 10.0F;
constexpr float most_certain = 10.0F;

/// Speed at which two dead-reckoned vehicles approach each other, m/s; 0 when they are at one place.
float closing_speed_mps(const Tracks& tracks, RowPair pair) {
    const traffic::MotionState& left = tracks.state[pair.left];
    const traffic::MotionState& right = tracks.state[pair.right];
    const float x_m = right.x_m - left.x_m;
    const float y_m = right.y_m - left.y_m;
    const float distance_m = std::hypot(x_m, y_m);
    if (distance_m < 1.0F) return 0.0F;
    const float vx_mps =
        left.speed_mps * std::cos(left.heading_rad) - right.speed_mps * std::cos(right.heading_rad);
    const float vy_mps =
        left.speed_mps * std::sin(left.heading_rad) - right.speed_mps * std::sin(right.heading_rad);
    return (vx_mps * x_m + vy_mps * y_m) / distance_m;
}

}  // namespace

FeatureSchema pair_feature_schema() {
    return {"pair_features", 1, static_cast<std::uint32_t>(pair_feature_count)};
}

PairFeatures pair_features(const Scene& scene, std::size_t at, float radius_m) {
    const Tracks& tracks = scene.tracks;
    const RowPair pair = scene.candidates.rows[at];
    const float margin_m = radius_m - std::min(longest_m, scene.candidates.dead_reckoned_m[at]);
    const float margin_seen_m = radius_m - std::min(longest_m, scene.candidates.last_seen_m[at]);
    const auto [younger_s, older_s] = std::minmax(tracks.age_s[pair.left], tracks.age_s[pair.right]);
    const float sigma_m =
        std::hypot(dead_reckoned_sigma_m(tracks.sensor_sigma_m[pair.left], tracks.age_s[pair.left]),
                   dead_reckoned_sigma_m(tracks.sensor_sigma_m[pair.right], tracks.age_s[pair.right]));
    return {margin_m / metres_each,
            margin_seen_m / metres_each,
            older_s / seconds_each,
            younger_s / seconds_each,
            std::clamp(margin_m / (sigma_m + 1.0F), -most_certain, most_certain),
            margin_m / metres_each * std::exp(-older_s / seconds_each),
            closing_speed_mps(tracks, pair) / speed_each_mps,
            std::log1p(sigma_m)};
}

}  // namespace clearway::prediction
