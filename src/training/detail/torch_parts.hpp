#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <ATen/ATen.h>
#include <ATen/CPUGeneratorImpl.h>
#include <ATen/Context.h>
#include <ATen/Parallel.h>
#include <torch/types.h>

#include "training/trainer.hpp"

namespace clearway::training::detail {

// What the nets of this module share. Only for source files that include torch anyway.

inline torch::Tensor index_tensor(const std::vector<std::int64_t>& values) {
    // from_blob takes a non-const pointer; nothing below writes through it.
    return torch::from_blob(const_cast<std::int64_t*>(values.data()),
                            {static_cast<std::int64_t>(values.size())}, torch::kInt64);
}

inline torch::Tensor float_tensor(const std::vector<float>& values, at::IntArrayRef shape) {
    return torch::from_blob(const_cast<float*>(values.data()), shape, torch::kFloat32);
}

/// Rows of `x` by number. Gather and its gradient scatter_add run over elements; index_select's gradient
/// calls torch for each row and is many times slower on one core.
inline torch::Tensor rows_of(const torch::Tensor& x, const torch::Tensor& index) {
    return x.gather(0, index.unsqueeze(1).expand({-1, x.size(1)}));
}

inline torch::Tensor uniform_parameter(at::IntArrayRef shape, std::int64_t inputs, at::Generator& generator) {
    const double bound = 1.0 / std::sqrt(static_cast<double>(inputs));
    return torch::empty(shape).uniform_(-bound, bound, generator).requires_grad_(true);
}

/// Glorot and Bengio 2010; `fans`: inputs and outputs together.
inline torch::Tensor glorot_parameter(at::IntArrayRef shape, std::int64_t fans, at::Generator& generator) {
    const double bound = std::sqrt(6.0 / static_cast<double>(fans));
    return torch::empty(shape).uniform_(-bound, bound, generator).requires_grad_(true);
}

struct Linear {
    Linear(std::int64_t inputs, std::int64_t outputs, at::Generator& generator)
        : weight(uniform_parameter({outputs, inputs}, inputs, generator)),
          bias(uniform_parameter({outputs}, inputs, generator)) {}
    torch::Tensor operator()(const torch::Tensor& x) const { return at::linear(x, weight, bias); }
    torch::Tensor weight, bias;
};

using NamedTensors = std::vector<std::pair<std::string, torch::Tensor>>;

prediction::Tensor to_named(const std::string& name, const torch::Tensor& tensor);
StateDict state_of(const NamedTensors& named);
/// Throws std::logic_error for other names or shapes.
void copy_state(const StateDict& state, const NamedTensors& named);
std::vector<torch::Tensor> tensors_of(const NamedTensors& named);

/// One core, deterministic algorithms, and a generator of its own.
at::Generator prepared_generator(std::uint64_t seed);

}  // namespace clearway::training::detail
