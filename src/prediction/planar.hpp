#pragma once

#include <memory>

#include "core/fields.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction {

// Comparisons that do not use the road network: they move vehicles and judge links in the plane. The position
// on the map (lane, lane position, position in the route), which policies also need, is that of dead
// reckoning along the route. Where exits are not known, a vehicle that its speed took past the end of its
// route has left.

/// Vehicles go straight on by their reported heading and speed. P(d < r) as kinematic.hpp has it.
std::unique_ptr<Predictor> make_dead_reckoning_heading(const PredictorContext& context,
                                                       const DeadReckoningConfig& config = {});

struct KalmanConfig {
    double along_psd = 1.0;
    double across_psd = 0.1;
    double speed_sigma_mps = 0.1;

    static constexpr void fields(const auto& table) {
        using C = KalmanConfig;
        table(core::Field{"along_psd", "m2/s3", &C::along_psd, 1e-6, 1000.0,
                          "Process noise: power spectral density of the white acceleration along the heading",
                          "tuned on validation seeds: of 1, 2, 3 the best AP in B10"},
              core::Field{"across_psd", "m2/s3", &C::across_psd, 1e-6, 1000.0, "The same across the heading",
                          "tuned likewise: of 0.01, 0.1, 0.4"},
              core::Field{"speed_sigma_mps", "m/s", &C::speed_sigma_mps, 1e-3, 50.0,
                          "Measurement noise of a reported velocity, along each axis",
                          "tuned: flat from 0.05 to 0.2; the presets have no speed noise"});
    }
};

/// A Kalman filter for each vehicle over its reports (motion_filter.hpp), measurement noise the sensor's
/// stated position error and `speed_sigma_mps`. P(d < r) from the covariances of both ends
/// (disc_probability.hpp). A report older than the one before (another run) starts a vehicle's filter anew.
std::unique_ptr<Predictor> make_kalman(const PredictorContext& context, const KalmanConfig& config = {});

}  // namespace clearway::prediction
