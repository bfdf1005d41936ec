#pragma once

#include <memory>

#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// The strongest repair without learning: dead reckoning along the route, not through red lights nor through
/// the vehicle ahead, drawn to where surviving links can be, and gone at the end of the route where exits are
/// not known (RoadAheadBuilder says how). P(d < radius) from the distance of the believed places, whose
/// standard deviation grows with age.
std::unique_ptr<Predictor> make_route_rule(const PredictorContext& context);

/// Standard deviation of the rule's displacement, m: that of the sensor, and 0.5 m + 1.2 m (age / 1 s)^1.25,
/// at most 80 m, as independent parts. Of the numbers tried these gave the least log loss in A.5 and B10 on
/// the dense merge, intersection and city, on seeds that serve for nothing else.
float route_rule_sigma_m(float sensor_sigma_m, float age_s);

}  // namespace clearway::prediction
