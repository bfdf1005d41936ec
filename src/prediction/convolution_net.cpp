#include "prediction/convolution_net.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "prediction/detail/lane_count.hpp"
#include "prediction/detail/tensor_layout.hpp"

namespace clearway::prediction {
namespace {

/// Slope of the attention's leaky ReLU below zero (Velickovic et al. 2018, section 2.1).
constexpr float leaky_slope = 0.2F;

float leaky(float value) {
    return value < 0.0F ? leaky_slope * value : value;
}

float dot(const float* left, const float* right, std::size_t size) {
    float sum = 0.0F;
    for (std::size_t at = 0; at < size; ++at)
        sum += left[at] * right[at];
    return sum;
}

}  // namespace

const char* ConvolutionNet::architecture(GraphConvolution convolution) {
    return convolution == GraphConvolution::gcn ? "gcn_net" : "gat_net";
}

ConvolutionNet::ConvolutionNet(GraphConvolution convolution, const Weights& weights,
                               const FeatureSchema& features)
    : convolution_(convolution) {
    weights.require(architecture(convolution), features);
    dimensions_ = {weights.dimension("input"), weights.dimension("hidden"), weights.dimension("output")};
    const std::string prefix = convolution == GraphConvolution::gcn ? "gcn." : "gat.";
    first_ = layer_from(weights, prefix + "conv1", features.width, dimensions_.hidden);
    second_ = layer_from(weights, prefix + "conv2", dimensions_.hidden, dimensions_.output);
    decoder_ = PairDecoder(weights, dimensions_.output, dimensions_.hidden, best_kernel());
    weights.require_tensors(convolution == GraphConvolution::gcn ? 8 : 12);
}

ConvolutionNet::Layer ConvolutionNet::layer_from(const Weights& weights, const std::string& name,
                                                 std::uint32_t inputs, std::uint32_t outputs) const {
    Layer layer;
    layer.weight = detail::transposed(weights.tensor(name + ".lin.weight", {outputs, inputs}));
    layer.bias = detail::padded_vector(weights.tensor(name + ".bias", {outputs}));
    layer.inputs = inputs;
    layer.outputs = outputs;
    if (convolution_ == GraphConvolution::gat) {
        layer.source_attention = detail::padded_vector(weights.tensor(name + ".att_src", {1, 1, outputs}));
        layer.target_attention = detail::padded_vector(weights.tensor(name + ".att_dst", {1, 1, outputs}));
    }
    return layer;
}

/// W x of every row, and what the shares need of each.
void ConvolutionNet::project(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
                             std::size_t count) {
    const std::size_t stride = detail::padded(layer.outputs);
    projected_.assign(count * stride, 0.0F);
    for (std::size_t row = 0; row < count; ++row) {
        float* const result = projected_.data() + row * stride;
        for (std::size_t input = 0; input < layer.inputs; ++input) {
            const float factor = rows[row * row_stride + input];
            const float* const weight = layer.weight.data() + input * stride;
            for (std::size_t at = 0; at < stride; ++at)
                result[at] += factor * weight[at];
        }
    }
    if (convolution_ == GraphConvolution::gcn) return;
    source_.resize(count);
    target_.resize(count);
    for (std::size_t row = 0; row < count; ++row) {
        const float* const own = projected_.data() + row * stride;
        source_[row] = dot(own, layer.source_attention.data(), stride);
        target_[row] = dot(own, layer.target_attention.data(), stride);
    }
}

void ConvolutionNet::weigh_by_degree(const MessageGraph& graph, std::size_t row) {
    const std::size_t begin = graph.first[row];
    const std::size_t count = graph.first[row + 1] - begin;
    for (std::size_t at = 0; at < count; ++at)
        share_[at] = source_[graph.source[begin + at]] * source_[row];
    share_[count] = source_[row] * source_[row];
}

void ConvolutionNet::weigh_by_attention(const MessageGraph& graph, std::size_t row) {
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

void ConvolutionNet::apply(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
                           const MessageGraph& graph, std::vector<float>& result) {
    const std::size_t count = graph.first.size() - 1;
    const std::size_t stride = detail::padded(layer.outputs);
    project(layer, rows, row_stride, count);
    result.resize(count * stride);
    for (std::size_t row = 0; row < count; ++row) {
        const std::size_t begin = graph.first[row];
        const std::size_t messages = graph.first[row + 1] - begin;
        share_.resize(std::max(share_.size(), messages + 1));
        convolution_ == GraphConvolution::gcn ? weigh_by_degree(graph, row) : weigh_by_attention(graph, row);
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

void ConvolutionNet::logits(std::span<const float> features, const MessageGraph& graph,
                            std::span<const RowPair> pairs, std::vector<float>& logits) {
    const std::size_t count = graph.first.size() - 1;
    assert(features.size() == count * dimensions_.input);
    if (convolution_ == GraphConvolution::gcn) {
        source_.assign(count, 1.0F);
        for (std::size_t row = 0; row < count; ++row) {
            for (std::size_t at = graph.first[row]; at < graph.first[row + 1]; ++at)
                source_[row] += graph.source[at] == row ? 0.0F : 1.0F;
            source_[row] = 1.0F / std::sqrt(source_[row]);
        }
    }
    apply(first_, features, dimensions_.input, graph, hidden_);
    apply(second_, hidden_, detail::padded(dimensions_.hidden), graph, embeddings_);
    decoder_.logits(embeddings_, pairs, logits);
}

}  // namespace clearway::prediction
