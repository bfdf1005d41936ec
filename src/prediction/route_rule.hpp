#pragma once

#include <memory>

#include "core/fields.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// How queues start at green, and how the standard deviation of the rule's displacement grows with the age of
/// a report.
struct RouteRuleConfig {
    double start_acceleration_mps2 = 1.5;
    /// Speed at which the start runs back through a queue. Of those tried (1, 1.5, 2; 3.5, 5, 8) the best
    /// AP in B20 on study seed 7001.
    static constexpr double start_wave_mps = 8.0;
    // Of the numbers tried these had the least log loss in A.5 and B10, dense.
    /// At an age just above 0.
    static constexpr double first_sigma_m = 0.5;
    /// Growth until an age of 1 s.
    static constexpr double growth_m = 1.2;
    /// Power of the age in s.
    static constexpr double growth_power = 1.25;
    /// Upper bound.
    static constexpr double most_sigma_m = 80.0;

    static constexpr void fields(const auto& table) {
        using C = RouteRuleConfig;
        constexpr const char* queues =
            "the best average precision in B20 of those tried, 1 to 8, on a seed of its own";
        table(core::Field{"start_acceleration_mps2", "m/s2", &C::start_acceleration_mps2, 0.0, 10.0,
                          "Acceleration of a vehicle that was seen standing, once its light is green and the "
                          "queue ahead moves; 0: it stays",
                          queues});
    }
};

/// The strongest repair without learning: dead reckoning along the route that stops at red lights, starts
/// again at green, stops behind the vehicle ahead, is drawn to where surviving links are possible, and
/// removes vehicles at the end of their route if exits are not known (see MotionContextBuilder). P(d <
/// radius) from the distance of the believed places, whose standard deviation grows with age.
std::unique_ptr<Predictor> make_route_rule(const PredictorContext& context,
                                           const RouteRuleConfig& config = {});

/// Standard deviation of the rule's displacement, m: that of the sensor, and first_sigma_m + growth_m (age /
/// 1 s)^growth_power, at most most_sigma_m, as independent parts.
float route_rule_sigma_m(float sensor_sigma_m, float age_s, const RouteRuleConfig& config);

}  // namespace clearway::prediction
