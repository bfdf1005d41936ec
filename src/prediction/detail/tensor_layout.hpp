#pragma once

#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction::detail {

/// PyTorch's [outputs][inputs] as [inputs][padded outputs], so that the outputs of one input lie side by
/// side.
std::vector<float> transposed(const Tensor& tensor);
/// The values, and zeros up to a multiple of lane_count.
std::vector<float> padded_vector(const Tensor& tensor);

}  // namespace clearway::prediction::detail
