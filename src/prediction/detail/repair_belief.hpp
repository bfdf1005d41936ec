#pragma once

#include "prediction/candidates.hpp"
#include "prediction/motion_context.hpp"

namespace clearway::prediction::detail {

// What the predictors that start from twins share.

/// Whether a vehicle is past the end of its route where exits are not known: its twin, or the rule where it
/// has none. The scene has twins.
bool has_left(const Scene& scene, const MotionContext& ahead);

/// Standard deviation of the place of a twin, or of the route rule's where there is none.
float believed_sigma_m(const Tracks& tracks, const MotionContext& ahead);

}  // namespace clearway::prediction::detail
