#include "prediction/motion_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace clearway::prediction {
namespace {

constexpr float longest_silence_s = 30.0F;

/// What a report says of the state, with the variance of each number.
struct Measurement {
    std::array<float, 4> value;
    std::array<float, 4> variance;
};

Measurement measurement_of(const traffic::MotionState& seen, float sigma_m, const FilterNoise& noise) {
    return {{seen.x_m, seen.y_m, seen.speed_mps * std::cos(seen.heading_rad),
             seen.speed_mps * std::sin(seen.heading_rad)},
            {sigma_m * sigma_m, sigma_m * sigma_m, noise.speed_var, noise.speed_var}};
}

/// Corrects by the four numbers one after the other, because their errors are independent. A position without
/// a stated error gets the variance `least_position_var_m2`, and its mean is then set to the report. With a
/// smaller variance, rounding would decide the gain across the heading, where the filter itself is certain.
void correct(const Measurement& measured, MotionFilter& filter) {
    constexpr float least_position_var_m2 = 0.01F;
    auto& p = filter.covariance;
    for (std::size_t at = 0; at < 4; ++at) {
        const float variance =
            at < 2 ? std::max(measured.variance[at], least_position_var_m2) : measured.variance[at];
        const float total = p[at][at] + variance;
        const float innovation = measured.value[at] - filter.mean[at];
        const std::array<float, 4> row = p[at];
        for (std::size_t i = 0; i < 4; ++i) {
            filter.mean[i] += row[i] / total * innovation;
            // Both halves get the same number, because rounding differences would grow with every step.
            for (std::size_t j = 0; j <= i; ++j) {
                p[i][j] -= row[i] * row[j] / total;
                p[j][i] = p[i][j];
            }
        }
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (measured.variance[axis] == 0.0F) filter.mean[axis] = measured.value[axis];
    }
}

}  // namespace

void start(const traffic::MotionState& seen, float sigma_m, const FilterNoise& noise, MotionFilter& filter) {
    const Measurement measured = measurement_of(seen, sigma_m, noise);
    filter.mean = measured.value;
    filter.covariance = {};
    for (std::size_t i = 0; i < 4; ++i) {
        filter.covariance[i][i] = measured.variance[i];
    }
}

void elapse(float elapsed_s, float heading_rad, const FilterNoise& noise, MotionFilter& filter) {
    auto& mean = filter.mean;
    auto& p = filter.covariance;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        mean[axis] += mean[axis + 2] * elapsed_s;
        for (std::size_t i = 0; i < 4; ++i) {
            p[axis][i] += elapsed_s * p[axis + 2][i];
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            p[i][axis] += elapsed_s * p[i][axis + 2];
        }
    }
    const std::array<float, 2> ahead = {std::cos(heading_rad), std::sin(heading_rad)};
    const float square = elapsed_s * elapsed_s;
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            const float psd = (noise.along_psd - noise.across_psd) * ahead[i] * ahead[j] +
                              (i == j ? noise.across_psd : 0.0F);
            p[i][j] += psd * square * elapsed_s / 3.0F;
            p[i][j + 2] += psd * square / 2.0F;
            p[i + 2][j] += psd * square / 2.0F;
            p[i + 2][j + 2] += psd * elapsed_s;
        }
    }
}

// NOLINTNEXTLINE(readability-function-size): what start() takes, and the time
void follow(const traffic::MotionState& seen, float sigma_m, float elapsed_s, const FilterNoise& noise,
            MotionFilter& filter) {
    if (elapsed_s > longest_silence_s) {
        start(seen, sigma_m, noise, filter);
        return;
    }
    elapse(elapsed_s, seen.heading_rad, noise, filter);
    correct(measurement_of(seen, sigma_m, noise), filter);
}

}  // namespace clearway::prediction
