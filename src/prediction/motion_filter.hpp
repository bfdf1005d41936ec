#pragma once

#include <array>

#include "traffic/observation.hpp"

namespace clearway::prediction {

/// A constant-velocity Kalman filter of one vehicle over its reports (position, and velocity from speed and
/// heading): state (x, y, vx, vy), continuous white noise acceleration (Bar-Shalom, Li, Kirubarajan 2001,
/// "Estimation with Applications to Tracking and Navigation", 6.2.2) that is stronger along the heading than
/// across it.
struct MotionFilter {
    std::array<float, 4> mean{};  ///< m, m, m/s, m/s.
    std::array<std::array<float, 4>, 4> covariance{};
};

/// Power spectral densities of the acceleration, m2/s3, and the variance of a reported velocity, m2/s2.
struct FilterNoise {
    float along_psd = 1.0F;
    float across_psd = 0.1F;
    float speed_var = 0.01F;
};

/// Starts at a report whose position has a standard deviation of `sigma_m` along each axis.
void start(const traffic::MotionState& seen, float sigma_m, const FilterNoise& noise, MotionFilter& filter);

/// x += vx t; P = F P F' + Q, Q the noise of a direction times (t^3 / 3, t^2 / 2; t^2 / 2, t).
void elapse(float elapsed_s, float heading_rad, const FilterNoise& noise, MotionFilter& filter);

/// Takes in a report that comes `elapsed_s` after the one before. A position without a stated error
/// (`sigma_m` 0) is taken unchanged. After half a minute of silence the filter starts anew, because the old
/// state adds nothing to a new report and larger variances would exceed single precision.
void follow(const traffic::MotionState& seen, float sigma_m, float elapsed_s, const FilterNoise& noise,
            MotionFilter& filter);

}  // namespace clearway::prediction
