#pragma once

namespace clearway::prediction {

/// The relative position of two vehicles, normal in the plane: mean (x, y) and covariance, sums of those of
/// both ends.
struct RelativePosition {
    float x_m = 0.0F;
    float y_m = 0.0F;
    float xx_m2 = 0.0F;
    float xy_m2 = 0.0F;
    float yy_m2 = 0.0F;
};

/// P(d < radius) for the distance d of two vehicles: the mass of the normal distribution within the disc.
///
/// In the frame of the principal axes, with standard deviations s >= t and mean (u, v) along them,
///
///     P = integral over y in [-r, r] of phi((y - v) / t) / t
///             x [Phi((h(y) - u) / s) - Phi((-h(y) - u) / s)] dy,     h(y) = sqrt(r^2 - y^2)
///
/// (a quadratic form in normal variables: Imhof 1961). For s = t it is the non-central chi-square
/// distribution with 2 degrees of freedom and non-centrality (u^2 + v^2) / s^2 at (r / s)^2, 1 - Q1 with
/// Marcum's Q. Computed with y = r sin(angle) by 24-point Gauss-Legendre quadrature over v +- 6 t: within
/// 2e-4. A step function without errors of position. Pure, no allocation.
float probability_in_disc(float radius_m, const RelativePosition& position);

}  // namespace clearway::prediction
