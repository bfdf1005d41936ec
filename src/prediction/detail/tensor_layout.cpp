#include "prediction/detail/tensor_layout.hpp"

#include "prediction/detail/lane_count.hpp"

namespace clearway::prediction::detail {

std::vector<float> transposed(const Tensor& tensor) {
    const std::size_t outputs = tensor.shape[0];
    const std::size_t inputs = tensor.shape[1];
    const std::size_t stride = padded(outputs);
    std::vector<float> result(inputs * stride, 0.0F);
    for (std::size_t output = 0; output < outputs; ++output) {
        for (std::size_t input = 0; input < inputs; ++input) {
            result[input * stride + output] = tensor.values[output * inputs + input];
        }
    }
    return result;
}

std::vector<float> padded_vector(const Tensor& tensor) {
    std::vector<float> result = tensor.values;
    result.resize(padded(result.size()), 0.0F);
    return result;
}

}  // namespace clearway::prediction::detail
