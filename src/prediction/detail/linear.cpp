#include "prediction/detail/linear.hpp"

#include <algorithm>

#include "prediction/detail/net_kernel.hpp"

namespace clearway::prediction::detail {

Linear::Linear(const Weights& weights, const std::string& name, std::uint32_t input_count,
               std::uint32_t output_count, Bias kind)
    : inputs(input_count), outputs(output_count) {
    const Tensor& tensor = weights.tensor(name + ".weight", {outputs, inputs});
    weight.assign(inputs * stride(), 0.0F);
    for (std::size_t output = 0; output < outputs; ++output) {
        for (std::size_t input = 0; input < inputs; ++input)
            weight[input * stride() + output] = tensor.values[output * inputs + input];
    }
    if (kind == Bias::own) bias = padded_vector(weights.tensor(name + ".bias", {outputs}));
    if (kind == Bias::zero) bias.assign(stride(), 0.0F);
}

// NOLINTNEXTLINE(readability-function-size): a matrix, what goes in, and where it comes out
void apply(Kernel kernel, const Linear& linear, const Numbers& input, Rows rows, Activation activation,
           std::vector<float>& result) {
    DenseTask task;
    task.input = input.first;
    task.input_stride = input.stride;
    task.inputs = std::min<std::size_t>(linear.inputs, input.width);
    task.rows = rows.numbers;
    task.row_count = rows.count;
    task.weight = linear.weight.data();
    task.bias = linear.bias.empty() ? nullptr : linear.bias.data();
    task.rectified = activation == Activation::rectified;
    task.result = result.data();
    task.result_stride = linear.stride();
    kernel == Kernel::avx2 ? dense_avx2(task) : dense_scalar(task);
}

std::vector<float> padded_vector(const Tensor& tensor) {
    std::vector<float> result = tensor.values;
    result.resize(padded(result.size()), 0.0F);
    return result;
}

}  // namespace clearway::prediction::detail
