#include "prediction/detail/detections.hpp"

#include <algorithm>
#include <cmath>

#include "prediction/motion_context.hpp"

namespace clearway::prediction::detail {
namespace {

constexpr float speed_change_mps = 2.5F;
constexpr float miss_scale_m = 5.0F;
/// Places tried for a detected vehicle: every 1/64 of its reach.
constexpr int places_tried = 64;

float square(float value) {
    return value * value;
}

/// How far a place is from what was detected.
float miss_m(const Detection& detection, const Tracks& tracks, roads::Point place, float link_radius_m) {
    const float distance_m = std::sqrt(square(place.x_m - tracks.x_m[detection.from]) +
                                       square(place.y_m - tracks.y_m[detection.from]));
    return detection.range_m >= 0.0F ? distance_m - detection.range_m
                                     : std::max(0.0F, distance_m - link_radius_m);
}

}  // namespace

void Detections::list(const Scene& scene) {
    all_.clear();
    for (std::size_t at = 0; at < scene.detected.size(); ++at) {
        const auto [left, right] = scene.detected.rows[at];
        const float range_m = scene.detected_range_m[at];
        if (scene.tracks.known[left] == 0) all_.push_back({left, right, range_m});
        if (scene.tracks.known[right] == 0) all_.push_back({right, left, range_m});
    }
    std::ranges::sort(all_);
}

std::span<const Detection> Detections::of(std::uint32_t row) const {
    const auto first = std::ranges::lower_bound(all_, row, {}, &Detection::row);
    const auto last = std::ranges::find_if(
        first, all_.end(), [row](const Detection& detection) { return detection.row != row; });
    return {first, last};
}

float agreed_displacement_m(const MotionContext& entry, std::span<const Detection> detections,
                            const Tracks& tracks, double link_radius_m, float believed_m) {
    const auto radius_m = static_cast<float>(link_radius_m);
    const float scale_m = 1.0F + speed_change_mps * tracks.age_s[entry.row];
    const auto cost = [&](float displacement_m) {
        float sum = square((displacement_m - believed_m) / scale_m);
        const roads::Point place = entry.place_at(displacement_m);
        for (const Detection& detection : detections) {
            if (tracks.known[detection.from] != 0)
                sum += square(miss_m(detection, tracks, place, radius_m) / miss_scale_m);
        }
        return sum;
    };
    float best_m = believed_m;
    float least = cost(best_m);
    for (int at = 0; at <= places_tried; ++at) {
        const float displacement_m =
            entry.reach_m * static_cast<float>(at) / static_cast<float>(places_tried);
        const float here = cost(displacement_m);
        if (here >= least) continue;
        least = here;
        best_m = displacement_m;
    }
    return best_m;
}

}  // namespace clearway::prediction::detail
