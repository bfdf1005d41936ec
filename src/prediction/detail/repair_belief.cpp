#include "prediction/detail/repair_belief.hpp"

#include <cmath>

#include "prediction/car_following.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/route_rule.hpp"

namespace clearway::prediction::detail {

bool has_left(const Scene& scene, const MotionContext& ahead) {
    if (!ahead.drives) return ahead.has_left;
    return !scene.tracks.exits_known && scene.twins->at_end(ahead.row);
}

float believed_sigma_m(const Tracks& tracks, const MotionContext& ahead) {
    const float age_s = tracks.age_s[ahead.row];
    if (!ahead.drives) return route_rule_sigma_m(ahead.sigma_m, age_s, RouteRuleConfig{});
    return std::hypot(ahead.sigma_m, deviation_of_spread * twin_spread_m(age_s, 0.0F, CarFollowingConfig{}));
}

}  // namespace clearway::prediction::detail
