#include "prediction/disc_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace clearway::prediction {
namespace {

struct Node {
    float place;
    float weight;
};

/// Gauss-Legendre, 24 points on [-1, 1]: the positive half (Abramowitz and Stegun 1964, table 25.4).
constexpr std::array<Node, 12> half_rule = {{{0.0640568929F, 0.1279381953F},
                                             {0.1911188675F, 0.1258374563F},
                                             {0.3150426797F, 0.1216704729F},
                                             {0.4337935076F, 0.1155056681F},
                                             {0.5454214714F, 0.1074442701F},
                                             {0.6480936519F, 0.0976186521F},
                                             {0.7401241916F, 0.0861901615F},
                                             {0.8200019860F, 0.0733464814F},
                                             {0.8864155270F, 0.0592985849F},
                                             {0.9382745520F, 0.0442774388F},
                                             {0.9747285560F, 0.0285313886F},
                                             {0.9951872200F, 0.0123412298F}}};

/// Beyond this many standard deviations the density counts as 0.
constexpr float reach = 6.0F;
/// Deviations below this are one, m: the quadrature needs a width.
constexpr float least_deviation_m = 1e-3F;

/// The position in the frame of its principal axes.
struct Principal {
    float along_m, across_m;          ///< Mean.
    float along_sigma, across_sigma;  ///< Deviations, the first the larger.
};

Principal principal_axes(const RelativePosition& position) {
    const float middle = 0.5F * (position.xx_m2 + position.yy_m2);
    const float spread = std::hypot(0.5F * (position.xx_m2 - position.yy_m2), position.xy_m2);
    const float angle = 0.5F * std::atan2(2.0F * position.xy_m2, position.xx_m2 - position.yy_m2);
    const float cosine = std::cos(angle);
    const float sine = std::sin(angle);
    return {cosine * position.x_m + sine * position.y_m, cosine * position.y_m - sine * position.x_m,
            std::sqrt(std::max(0.0F, middle + spread)), std::sqrt(std::max(0.0F, middle - spread))};
}

/// Probability of the standard normal distribution between two values.
float mass_between(float low, float high) {
    constexpr float scale = 1.0F / std::numbers::sqrt2_v<float>;
    return 0.5F * (std::erf(high * scale) - std::erf(low * scale));
}

}  // namespace

float probability_in_disc(float radius_m, const RelativePosition& position) {
    const float offset_m = std::hypot(position.x_m, position.y_m);
    Principal axes = principal_axes(position);
    if (axes.along_sigma < least_deviation_m || offset_m - radius_m > reach * axes.along_sigma) {
        return offset_m < radius_m ? 1.0F : 0.0F;
    }
    if (radius_m - offset_m > reach * axes.along_sigma) return 1.0F;
    axes.across_sigma = std::max(axes.across_sigma, least_deviation_m);
    const auto angle_of = [&](float across_m) {
        return std::asin(std::clamp(across_m / radius_m, -1.0F, 1.0F));
    };
    const float low = angle_of(axes.across_m - reach * axes.across_sigma);
    const float high = angle_of(axes.across_m + reach * axes.across_sigma);
    const float middle = 0.5F * (low + high);
    const float half = 0.5F * (high - low);
    const auto slice = [&](float angle) {
        const float half_chord_m = radius_m * std::cos(angle);
        const float across = (radius_m * std::sin(angle) - axes.across_m) / axes.across_sigma;
        return std::exp(-0.5F * across * across) * half_chord_m *
               mass_between((-half_chord_m - axes.along_m) / axes.along_sigma,
                            (half_chord_m - axes.along_m) / axes.along_sigma);
    };
    float sum = 0.0F;
    for (const Node& node : half_rule) {
        sum += node.weight * (slice(middle - half * node.place) + slice(middle + half * node.place));
    }
    const float mass = sum * half / (axes.across_sigma * std::sqrt(2.0F * std::numbers::pi_v<float>));
    return std::clamp(mass, 0.0F, 1.0F);
}

}  // namespace clearway::prediction
