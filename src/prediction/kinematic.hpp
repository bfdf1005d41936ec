#pragma once

#include <memory>

#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// No repair: vehicles whose newest report arrived, linked by reported distance. Whoever is dark does not
/// exist.
std::unique_ptr<Predictor> make_no_repair(const PredictorContext& context);

/// Vehicles stay where they were last seen, for ever.
std::unique_ptr<Predictor> make_last_seen(const PredictorContext& context);

/// Vehicles go on at their reported speed along their route, and leave at its end.
std::unique_ptr<Predictor> make_dead_reckoning(const PredictorContext& context);

/// Standard deviation of a held position, m: sqrt(sensor^2 + ((speed + 2 m/s) age)^2). The vehicle moved by
/// about speed x age; one that stood may have started (2 m/s is the mean over 3 s from standstill at 1.4
/// m/s^2).
float held_sigma_m(float sensor_sigma_m, float speed_mps, float age_s);

/// Standard deviation of a dead-reckoned position, m: sqrt(sensor^2 + (2.5 m/s age)^2). 2.5 m/s is assumed:
/// half of the usual change of speed between two signals.
float dead_reckoned_sigma_m(float sensor_sigma_m, float age_s);

/// P(d < radius) for a distance believed to be `distance_m` with standard deviation `sigma_m`, taken as
/// normal: 0.5 at the radius, steeper the smaller sigma is; a step for sigma 0.
float probability_within(float radius_m, float distance_m, float sigma_m);

}  // namespace clearway::prediction
