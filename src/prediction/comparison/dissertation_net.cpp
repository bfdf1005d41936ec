#include "prediction/comparison/dissertation_net.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace clearway::prediction {
namespace {

/// Slope of the attention's leaky ReLU below zero (Velickovic et al. 2018, section 2.1).
constexpr float leaky_slope = 0.2F;
/// Pairs that are decoded together: their inputs stay in the processor's cache.
constexpr std::size_t pairs_together = 48;

float leaky(float value) {
    return value < 0.0F ? leaky_slope * value : value;
}

float dot(const float* left, const float* right, std::size_t size) {
    float sum = 0.0F;
    for (std::size_t at = 0; at < size; ++at)
        sum += left[at] * right[at];
    return sum;
}

std::string architecture_of(Convolution convolution) {
    return convolution == Convolution::sage ? "graphsage_net"
                                            : fmt::format("{}_net", core::name(convolution));
}

std::string prefix_of(Convolution convolution) {
    return convolution == Convolution::sage ? "graphsage." : fmt::format("{}.", core::name(convolution));
}

/// The matrices of SAGEConv with their rows by turns.
detail::Linear sage_linear(const Weights& weights, const std::string& name, std::uint32_t inputs,
                           std::uint32_t outputs) {
    using detail::Linear;
    const Linear own(weights, name + ".lin_r", inputs, outputs, Linear::Bias::none);
    Linear both(weights, name + ".lin_l", inputs, outputs);
    const auto stride = static_cast<std::ptrdiff_t>(both.stride());
    std::vector<float> by_turns;
    for (std::ptrdiff_t at = 0; at < stride * inputs; at += stride) {
        for (const Linear* const one : {&std::as_const(both), &own})
            by_turns.insert(by_turns.end(), one->weight.begin() + at, one->weight.begin() + at + stride);
    }
    both.weight = std::move(by_turns);
    both.inputs = 2 * inputs;
    return both;
}

}  // namespace

std::vector<std::string> parameter_names(Convolution convolution) {
    std::vector<std::string> of_layer = {"lin.weight", "bias"};
    if (convolution == Convolution::sage) of_layer = {"lin_l.weight", "lin_l.bias", "lin_r.weight"};
    if (convolution == Convolution::gat) of_layer = {"lin.weight", "att_src", "att_dst", "bias"};
    std::vector<std::string> names;
    for (const char* const layer : {"conv1.", "conv2."}) {
        for (const std::string& name : of_layer)
            names.push_back(prefix_of(convolution) + layer + name);
    }
    names.insert(names.end(), {"nn.fc1.weight", "nn.fc1.bias", "nn.fc2.weight", "nn.fc2.bias"});
    return names;
}

Weights net_weights(Convolution convolution, const FeatureSchema& features, const NetDimensions& dimensions,
                    std::vector<Tensor> tensors) {
    Weights weights;
    weights.architecture = architecture_of(convolution);
    weights.features = features;
    weights.dimensions = {
        {"input", dimensions.input}, {"hidden", dimensions.hidden}, {"output", dimensions.output}};
    weights.tensors = std::move(tensors);
    return weights;
}

DissertationNet::DissertationNet(Convolution convolution, const Weights& weights,
                                 const FeatureSchema& features, Kernel kernel)
    : convolution_(convolution), kernel_(kernel) {
    weights.require(architecture_of(convolution), features);
    dimensions_ = {weights.dimension("input"), weights.dimension("hidden"), weights.dimension("output")};
    first_ = layer_from(weights, prefix_of(convolution) + "conv1", features.width, dimensions_.hidden);
    second_ = layer_from(weights, prefix_of(convolution) + "conv2", dimensions_.hidden, dimensions_.output);
    decoder_ = detail::Linear(weights, "nn.fc1", dimensions_.output, dimensions_.hidden);
    output_weight_ = detail::padded_vector(weights.tensor("nn.fc2.weight", {1, dimensions_.hidden}));
    output_bias_ = weights.tensor("nn.fc2.bias", {1}).values.front();
    weights.require_tensors(parameter_names(convolution).size());
}

DissertationNet::Layer DissertationNet::layer_from(const Weights& weights, const std::string& name,
                                                   std::uint32_t inputs, std::uint32_t outputs) const {
    Layer layer;
    layer.inputs = inputs;
    if (convolution_ == Convolution::sage) {
        layer.linear = sage_linear(weights, name, inputs, outputs);
        return layer;
    }
    layer.linear = detail::Linear(weights, name + ".lin", inputs, outputs, detail::Linear::Bias::zero);
    layer.bias = detail::padded_vector(weights.tensor(name + ".bias", {outputs}));
    if (convolution_ == Convolution::gat) {
        layer.source_attention = detail::padded_vector(weights.tensor(name + ".att_src", {1, 1, outputs}));
        layer.target_attention = detail::padded_vector(weights.tensor(name + ".att_dst", {1, 1, outputs}));
    }
    return layer;
}

void DissertationNet::apply_mean(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
                                 const MessageGraph& graph, std::vector<float>& result) {
    const std::size_t count = graph.first.size() - 1;
    const std::size_t width = 2 * std::size_t{layer.inputs};
    gathered_.assign(count * width, 0.0F);
    for (std::size_t row = 0; row < count; ++row) {
        const std::uint32_t begin = graph.first[row];
        const std::uint32_t end = graph.first[row + 1];
        const auto messages = static_cast<float>(end > begin ? end - begin : 1);
        float* const to = gathered_.data() + row * width;
        for (std::uint32_t message = begin; message < end; ++message) {
            const float* const from = rows.data() + graph.source[message] * row_stride;
            for (std::size_t input = 0; input < layer.inputs; ++input)
                to[2 * input] += from[input];
        }
        for (std::size_t input = 0; input < layer.inputs; ++input) {
            to[2 * input] /= messages;
            to[2 * input + 1] = rows[row * row_stride + input];
        }
    }
    result.resize(count * layer.linear.stride());
    detail::apply(kernel_, layer.linear, {gathered_.data(), width}, {nullptr, count},
                  detail::Activation::none, result);
}

/// W x of every row, and what the shares need of each.
void DissertationNet::project(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
                              std::size_t count) {
    const std::size_t stride = layer.linear.stride();
    projected_.resize(count * stride);
    detail::apply(kernel_, layer.linear, {rows.data(), row_stride}, {nullptr, count},
                  detail::Activation::none, projected_);
    if (convolution_ == Convolution::gcn) return;
    source_.resize(count);
    target_.resize(count);
    for (std::size_t row = 0; row < count; ++row) {
        const float* const own = projected_.data() + row * stride;
        source_[row] = dot(own, layer.source_attention.data(), stride);
        target_[row] = dot(own, layer.target_attention.data(), stride);
    }
}

void DissertationNet::count_degrees(const MessageGraph& graph) {
    source_.assign(graph.first.size() - 1, 1.0F);
    for (std::size_t row = 0; row < source_.size(); ++row) {
        for (std::size_t at = graph.first[row]; at < graph.first[row + 1]; ++at)
            source_[row] += graph.source[at] == row ? 0.0F : 1.0F;
        source_[row] = 1.0F / std::sqrt(source_[row]);
    }
}

void DissertationNet::weigh_by_degree(const MessageGraph& graph, std::size_t row) {
    const std::size_t begin = graph.first[row];
    const std::size_t count = graph.first[row + 1] - begin;
    for (std::size_t at = 0; at < count; ++at)
        share_[at] = source_[graph.source[begin + at]] * source_[row];
    share_[count] = source_[row] * source_[row];
}

void DissertationNet::weigh_by_attention(const MessageGraph& graph, std::size_t row) {
    const std::size_t begin = graph.first[row];
    const std::size_t count = graph.first[row + 1] - begin;
    for (std::size_t at = 0; at < count; ++at)
        share_[at] = leaky(source_[graph.source[begin + at]] + target_[row]);
    share_[count] = leaky(source_[row] + target_[row]);
    const auto end = share_.begin() + static_cast<std::ptrdiff_t>(count) + 1;
    const float greatest = *std::max_element(share_.begin(), end);
    float sum = 0.0F;
    for (std::size_t at = 0; at <= count; ++at) {
        const bool is_self = at < count && graph.source[begin + at] == row;
        share_[at] = is_self ? 0.0F : std::exp(share_[at] - greatest);
        sum += share_[at];
    }
    for (std::size_t at = 0; at <= count; ++at)
        share_[at] /= sum;
}

void DissertationNet::apply(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
                            const MessageGraph& graph, std::vector<float>& result) {
    if (convolution_ == Convolution::sage) return apply_mean(layer, rows, row_stride, graph, result);
    const std::size_t count = graph.first.size() - 1;
    const std::size_t stride = layer.linear.stride();
    project(layer, rows, row_stride, count);
    result.resize(count * stride);
    for (std::size_t row = 0; row < count; ++row) {
        const std::size_t begin = graph.first[row];
        const std::size_t messages = graph.first[row + 1] - begin;
        share_.resize(std::max(share_.size(), messages + 1));
        convolution_ == Convolution::gcn ? weigh_by_degree(graph, row) : weigh_by_attention(graph, row);
        float* const own = result.data() + row * stride;
        std::copy(layer.bias.begin(), layer.bias.end(), own);
        for (std::size_t message = 0; message <= messages; ++message) {
            const bool is_own = message == messages;
            const std::size_t source = is_own ? row : graph.source[begin + message];
            if (!is_own && source == row) continue;
            const float* const from = projected_.data() + source * stride;
            for (std::size_t at = 0; at < stride; ++at)
                own[at] += share_[message] * from[at];
        }
    }
}

void DissertationNet::decode(std::span<const RowPair> pairs, std::vector<float>& logits) {
    const std::size_t width = dimensions_.output;
    const std::size_t stride = decoder_.stride();
    logits.resize(pairs.size());
    products_.resize(pairs_together * width);
    decoded_.resize(pairs_together * stride);
    for (std::size_t first = 0; first < pairs.size(); first += pairs_together) {
        const std::size_t count = std::min(pairs_together, pairs.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const float* const left = embeddings_.data() + pairs[first + i].left * embedding_stride();
            const float* const right = embeddings_.data() + pairs[first + i].right * embedding_stride();
            for (std::size_t at = 0; at < width; ++at)
                products_[i * width + at] = left[at] * right[at];
        }
        detail::apply(kernel_, decoder_, {products_.data(), width}, {nullptr, count},
                      detail::Activation::rectified, decoded_);
        for (std::size_t i = 0; i < count; ++i) {
            // By lanes first: the order of additions in which the shipped nets were measured.
            float lanes[detail::lane_count] = {};
            for (std::size_t at = 0; at < stride; ++at)
                lanes[at % detail::lane_count] += decoded_[i * stride + at] * output_weight_[at];
            logits[first + i] = output_bias_;
            for (const float lane : lanes)
                logits[first + i] += lane;
        }
    }
}

void DissertationNet::logits(std::span<const float> features, const MessageGraph& graph,
                             std::span<const RowPair> pairs, std::vector<float>& logits) {
    assert(features.size() == (graph.first.size() - 1) * dimensions_.input);
    if (convolution_ == Convolution::gcn) count_degrees(graph);
    apply(first_, features, dimensions_.input, graph, hidden_);
    apply(second_, hidden_, first_.linear.stride(), graph, embeddings_);
    decode(pairs, logits);
}

}  // namespace clearway::prediction
