#pragma once

#include <memory>

#include "core/fields.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// No repair: only vehicles whose newest report arrived, linked by reported distance. Dark vehicles are left
/// out.
std::unique_ptr<Predictor> make_no_repair(const PredictorContext& context);

struct LastSeenConfig {
    double start_speed_mps = 2.0;

    static constexpr void fields(const auto& table) {
        using C = LastSeenConfig;
        table(core::Field{"start_speed_mps", "m/s", &C::start_speed_mps, 0.0, 50.0,
                          "Speed added to the last reported one, in the growth of the "
                          "position's standard deviation with age",
                          "mean over 3 s from standstill at 1.4 m/s2"});
    }
};

/// Vehicles stay where they were last seen, with no time limit.
std::unique_ptr<Predictor> make_last_seen(const PredictorContext& context, const LastSeenConfig& config = {});

struct DeadReckoningConfig {
    double speed_change_mps = 2.5;

    static constexpr void fields(const auto& table) {
        using C = DeadReckoningConfig;
        table(core::Field{"speed_change_mps", "m/s", &C::speed_change_mps, 0.0, 50.0,
                          "Growth of a position's standard deviation with the age of its report",
                          "assumed: half of the usual change of speed between two signals"});
    }
};

/// Vehicles go on at their reported speed along their route, and leave at its end where exits are not known.
std::unique_ptr<Predictor> make_dead_reckoning(const PredictorContext& context,
                                               const DeadReckoningConfig& config = {});

/// Standard deviation of a held position, m: sqrt(sensor^2 + ((speed + start_speed) age)^2). The vehicle
/// moved by about speed x age.
float held_sigma_m(float sensor_sigma_m, float speed_mps, float age_s, const LastSeenConfig& config = {});

/// Standard deviation of a dead-reckoned position, m: sqrt(sensor^2 + (speed_change age)^2).
float dead_reckoned_sigma_m(float sensor_sigma_m, float age_s, const DeadReckoningConfig& config = {});

/// P(d < radius) for a distance believed to be `distance_m` with standard deviation `sigma_m`, taken as
/// normal: 0.5 at the radius, steeper the smaller sigma is; a step for sigma 0.
float probability_within(float radius_m, float distance_m, float sigma_m);

}  // namespace clearway::prediction
