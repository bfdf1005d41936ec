#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/comparison/features.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction::testing {

/// A net of the published architecture with all parameters 0.
inline Weights zero_net(const FeatureSchema& features, std::uint32_t hidden, std::uint32_t output) {
    Weights weights;
    weights.architecture = "graphsage_net";
    weights.features = features;
    weights.dimensions = {{"input", features.width}, {"hidden", hidden}, {"output", output}};
    const auto add = [&](const std::string& name, std::vector<std::uint32_t> shape) {
        std::size_t count = 1;
        for (const std::uint32_t size : shape) {
            count *= size;
        }
        weights.tensors.push_back({name, std::move(shape), std::vector<float>(count, 0.0F)});
    };
    add("graphsage.conv1.lin_l.weight", {hidden, features.width});
    add("graphsage.conv1.lin_l.bias", {hidden});
    add("graphsage.conv1.lin_r.weight", {hidden, features.width});
    add("graphsage.conv2.lin_l.weight", {output, hidden});
    add("graphsage.conv2.lin_l.bias", {output});
    add("graphsage.conv2.lin_r.weight", {output, hidden});
    add("nn.fc1.weight", {hidden, output});
    add("nn.fc1.bias", {hidden});
    add("nn.fc2.weight", {1, hidden});
    add("nn.fc2.bias", {1});
    return weights;
}

/// A net with GCN or GAT, all parameters 0.
inline Weights zero_net(Convolution convolution, const FeatureSchema& features, std::uint32_t hidden,
                        std::uint32_t output) {
    Weights weights = zero_net(features, hidden, output);
    const bool is_gat = convolution == Convolution::gat;
    weights.architecture = is_gat ? "gat_net" : "gcn_net";
    const std::string prefix = is_gat ? "gat." : "gcn.";
    std::vector<Tensor> decoder(weights.tensors.end() - 4, weights.tensors.end());
    weights.tensors.clear();
    const auto add = [&](const std::string& name, std::uint32_t inputs, std::uint32_t outputs) {
        const auto zeros = [](std::size_t count) { return std::vector<float>(count, 0.0F); };
        weights.tensors.push_back(
            {prefix + name + ".lin.weight", {outputs, inputs}, zeros(std::size_t{outputs} * inputs)});
        weights.tensors.push_back({prefix + name + ".bias", {outputs}, zeros(outputs)});
        if (!is_gat) return;
        weights.tensors.push_back({prefix + name + ".att_src", {1, 1, outputs}, zeros(outputs)});
        weights.tensors.push_back({prefix + name + ".att_dst", {1, 1, outputs}, zeros(outputs)});
    };
    add("conv1", features.width, hidden);
    add("conv2", hidden, output);
    weights.tensors.insert(weights.tensors.end(), decoder.begin(), decoder.end());
    return weights;
}

inline std::vector<float>& values(Weights& weights, const std::string& name) {
    for (Tensor& tensor : weights.tensors) {
        if (tensor.name == name) return tensor.values;
    }
    throw std::out_of_range(name);
}

/// The same net with parameters drawn from N(0, scale).
inline Weights drawn(Weights weights, double scale) {
    const core::KeyedRandom random({7}, {0});
    std::uint64_t counter = 0;
    for (Tensor& tensor : weights.tensors) {
        for (float& value : tensor.values) {
            value = static_cast<float>(scale * random.normal(core::Purpose::training, 0, ++counter));
        }
    }
    return weights;
}
inline Weights random_net(const FeatureSchema& features, std::uint32_t hidden, std::uint32_t output,
                          double scale = 0.5) {
    return drawn(zero_net(features, hidden, output), scale);
}

/// A net on the corrected features, made by hand: both convolutions pass a vehicle's own inputs on, the
/// decoder adds the four products of the kernel and compares with their value at 50 m. Its probability falls
/// with the dead-reckoned distance and is 0.5 at about 50 m.
inline Weights kernel_net() {
    Weights weights = zero_net(corrected_schema(), 10, 5);
    for (std::size_t at = 0; at < 5; ++at) {
        values(weights, "graphsage.conv1.lin_r.weight")[at * 5 + at] = 1.0F;
        values(weights, "graphsage.conv2.lin_r.weight")[at * 10 + at] = 1.0F;
    }
    for (std::size_t product = 0; product < 4; ++product) {
        values(weights, "nn.fc1.weight")[product] = 1.0F / (corrected_amplitude * corrected_amplitude);
    }
    values(weights, "nn.fc2.weight")[0] = 40.0F;
    values(weights, "nn.fc2.bias")[0] = -40.0F * 1.7071068F;  // 1 + cos(2 pi 50 m / 400 m)
    return weights;
}

/// The same by another convolution. A vehicle that hears nobody passes its own inputs on.
inline Weights kernel_net(Convolution convolution) {
    const Weights kernel = kernel_net();
    Weights weights = zero_net(convolution, corrected_schema(), 10, 5);
    const std::string prefix = convolution == Convolution::gat ? "gat." : "gcn.";
    for (std::size_t at = 0; at < 5; ++at) {
        values(weights, prefix + "conv1.lin.weight")[at * 5 + at] = 1.0F;
        values(weights, prefix + "conv2.lin.weight")[at * 10 + at] = 1.0F;
    }
    std::copy(kernel.tensors.end() - 4, kernel.tensors.end(), weights.tensors.end() - 4);
    return weights;
}

}  // namespace clearway::prediction::testing
