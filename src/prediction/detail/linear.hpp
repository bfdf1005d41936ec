#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "prediction/detail/lane_count.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction::detail {

/// A matrix as the kernels take it, [inputs][padded outputs], so that the outputs of one input lie side by
/// side; and a bias, [padded outputs].
struct Linear {
    enum class Bias : std::uint8_t {
        none,  ///< The product is added to what the result holds.
        zero,
        own,
    };
    Linear() = default;
    /// Of the tensors NAME.weight, {outputs, inputs}, and NAME.bias. Throws core::InputError when they are
    /// missing or shaped otherwise.
    Linear(const Weights& weights, const std::string& name, std::uint32_t input_count,
           std::uint32_t output_count, Bias kind = Bias::own);
    std::size_t stride() const { return padded(outputs); }

    std::vector<float> weight, bias;
    std::uint32_t inputs = 0;
    std::uint32_t outputs = 0;
};

/// Numbers of the rows to compute; null: rows 0 to `count` - 1.
struct Rows {
    const std::uint32_t* numbers = nullptr;
    std::size_t count = 0;
};
/// Rows of numbers, one every `stride`. Those beyond `width` count as 0.
struct Numbers {
    const float* first = nullptr;
    std::size_t stride = 0;
    std::size_t width = SIZE_MAX;
};
enum class Activation : std::uint8_t { none, rectified };

/// Writes the rows of `result`, one every `linear.stride()`, which has room for them.
void apply(Kernel kernel, const Linear& linear, const Numbers& input, Rows rows, Activation activation,
           std::vector<float>& result);

/// The values, and zeros up to a multiple of lane_count.
std::vector<float> padded_vector(const Tensor& tensor);

}  // namespace clearway::prediction::detail
