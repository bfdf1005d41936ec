#pragma once

#include <span>
#include <vector>

#include "prediction/tracks.hpp"
#include "prediction/weights.hpp"
#include "roads/network.hpp"

namespace clearway::prediction {

// Inputs of the nets, one row per vehicle, row-major. Training and inference call the same functions. A
// change of any number below is a new version of its schema.

/// *As published* (chapter 5.3, `input_dim = 2`): the position (x, y) in m, in the network's plane.
FeatureSchema as_published_position_schema();
/// *As published*, our reading of chapter 4.1 ("position, speed, and lane information") with the class: (x m,
/// y m, speed m/s, number of the lane, class code: human 0, automated 1, emergency 2).
FeatureSchema as_published_attributes_schema();
/// *Corrected*, version 2 (version 1 lacked the factor 3): what an observer has of a vehicle, in a form in
/// which the published decoder can measure distance:
///
///     [3 cos kx, 3 sin kx, 3 cos ky, 3 sin ky, exp(-age / 10 s)]    k = 2 pi / 400 m, (x, y) dead-reckoned
///
/// Why: the published net is linear up to the Hadamard product, so from raw coordinates the decoder sees sums
/// of terms such as x_i x_j, which grow with the place on the map and hardly with the distance. Of the inputs
/// above the product of two vehicles' rows sums to 9 (cos(k dx) + cos(k dy)) = 9 (2 - k^2 d^2 / 2 + ...), a
/// kernel of the distance alone, wherever on the map, and to exp(-(age_i + age_j) / 10 s), the ages of both
/// ends. A weight per product and one threshold thus make dead reckoning that trusts old reports less. The
/// factor 3 lets the kernel fall by 1 in 10 m around the link radius of 50 m, about as fast as logits should;
/// without it training was uneven (log loss on unseen seeds 0.31 to 0.38 nat by learning rate, with it 0.31).
/// The kernel repeats after 400 m, so pairs whose dead-reckoned distance is `corrected_reach_m` or more are
/// not scored: their probability is 0, in training as in inference.
FeatureSchema corrected_schema();

inline constexpr float corrected_amplitude = 3.0F;
inline constexpr float corrected_wavelength_m = 400.0F;
inline constexpr float corrected_age_scale_s = 10.0F;
inline constexpr float corrected_reach_m = 200.0F;

/// Number that stands for a class: human 0, automated 1, emergency 2.
float class_code(traffic::VehicleClass vehicle_class);

/// One row of the published features from a vehicle's state; writes as many numbers as `row` has: 2 or 5.
void as_published_row(const traffic::MotionState& state, traffic::VehicleClass vehicle_class,
                      const roads::Network& network, std::span<float> row);

/// The published features at the last reported states; `schema` is one of the two published ones.
void as_published_features(const Tracks& tracks, const FeatureSchema& schema, const roads::Network& network,
                           std::vector<float>& features);
/// The corrected features at the dead-reckoned states.
void corrected_features(const Tracks& tracks, std::vector<float>& features);

}  // namespace clearway::prediction
