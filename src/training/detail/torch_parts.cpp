#include "training/detail/torch_parts.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <torch/utils.h>

namespace clearway::training::detail {

prediction::Tensor to_named(const std::string& name, const torch::Tensor& tensor) {
    const torch::Tensor flat = tensor.detach().contiguous();
    prediction::Tensor named{name, {}, {}};
    for (const std::int64_t size : flat.sizes())
        named.shape.push_back(static_cast<std::uint32_t>(size));
    named.values.assign(flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel());
    return named;
}

StateDict state_of(const NamedTensors& named) {
    StateDict state;
    for (const auto& [name, tensor] : named)
        state.push_back(to_named(name, tensor));
    return state;
}

void copy_state(const StateDict& state, const NamedTensors& named) {
    const torch::NoGradGuard no_gradient;
    if (named.size() != state.size()) throw std::logic_error("a state of another net");
    for (std::size_t at = 0; at < state.size(); ++at) {
        auto [name, tensor] = named[at];
        if (name != state[at].name || to_named(name, tensor).shape != state[at].shape) {
            throw std::logic_error(
                fmt::format("a state of another net: {} where {} belongs", state[at].name, name));
        }
        tensor.copy_(float_tensor(state[at].values, tensor.sizes()));
    }
}

std::vector<torch::Tensor> tensors_of(const NamedTensors& named) {
    std::vector<torch::Tensor> all;
    for (const auto& [name, tensor] : named)
        all.push_back(tensor);
    return all;
}

at::Generator prepared_generator(std::uint64_t seed) {
    at::set_num_threads(1);
    at::globalContext().setDeterministicAlgorithms(true, false);
    return at::detail::createCPUGenerator(seed);
}

}  // namespace clearway::training::detail
