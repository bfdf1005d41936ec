#pragma once

#include <array>
#include <string_view>

#include "prediction/candidates.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// Inputs of the logistic pair model for a candidate pair, `pair_features` version 1. r is the link radius, d
/// the dead-reckoned and l the last seen distance, both capped at 200 m:
///
///     margin        (r - d) / 10 m
///     margin_seen   (r - l) / 10 m
///     age_older     age of the older report / 10 s
///     age_younger   age of the younger report / 10 s
///     certainty     (r - d) / (s + 1 m), within [-10, 10]; s = sigma of d (kinematic.hpp, both ends)
///     margin_fading margin x exp(-age_older)
///     closing       speed at which the dead-reckoned places approach each other / 10 m/s
///     spread        ln(1 + s / 1 m)
FeatureSchema pair_feature_schema();
inline constexpr std::size_t pair_feature_count = 8;
inline constexpr std::array<std::string_view, pair_feature_count> pair_feature_names = {
    "margin", "margin_seen", "age_older", "age_younger", "certainty", "margin_fading", "closing", "spread"};

using PairFeatures = std::array<float, pair_feature_count>;

/// The features of candidate `at` of the scene.
PairFeatures pair_features(const Scene& scene, std::size_t at, float radius_m);

}  // namespace clearway::prediction
