#include "prediction/graphsage.hpp"

#include <cassert>
#include <cmath>

#include "prediction/detail/graphsage_kernel.hpp"

namespace clearway::prediction {
namespace {

/// PyTorch's [outputs][inputs] as [inputs][padded outputs], so that the outputs of one input lie side by
/// side.
std::vector<float> transposed(const Tensor& tensor) {
    const std::size_t outputs = tensor.shape[0];
    const std::size_t inputs = tensor.shape[1];
    const std::size_t stride = detail::padded(outputs);
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
    result.resize(detail::padded(result.size()), 0.0F);
    return result;
}

void pad_rows(std::span<const float> rows, std::size_t width, std::vector<float>& result) {
    const std::size_t stride = detail::padded(width);
    const std::size_t count = rows.size() / width;
    result.assign(count * stride, 0.0F);
    for (std::size_t row = 0; row < count; ++row) {
        for (std::size_t at = 0; at < width; ++at) {
            result[row * stride + at] = rows[row * width + at];
        }
    }
}

}  // namespace

void message_graph_from(std::span<const std::uint32_t> sources, std::span<const std::uint32_t> targets,
                        std::size_t row_count, MessageGraph& graph) {
    assert(sources.size() == targets.size());
    graph.first.assign(row_count + 1, 0);
    graph.source.resize(sources.size());
    for (const std::uint32_t target : targets) {
        assert(target < row_count);
        ++graph.first[target + 1];
    }
    for (std::size_t row = 0; row < row_count; ++row) {
        graph.first[row + 1] += graph.first[row];
    }
    for (std::size_t edge = 0; edge < sources.size(); ++edge) {
        graph.source[graph.first[targets[edge]]++] = sources[edge];
    }
    // Each start was moved to the end of its row, which is the start of the next one.
    for (std::size_t row = row_count; row > 0; --row) {
        graph.first[row] = graph.first[row - 1];
    }
    graph.first[0] = 0;
}

Kernel best_kernel() {
    return __builtin_cpu_supports("avx2") ? Kernel::avx2 : Kernel::scalar;
}

GraphSageNet::GraphSageNet(const Weights& weights, const FeatureSchema& features, Kernel kernel)
    : kernel_(kernel) {
    weights.require(architecture, features);
    dimensions_ = {weights.dimension("input"), weights.dimension("hidden"), weights.dimension("output")};
    first_ = convolution_from(weights, "graphsage.conv1", features.width, dimensions_.hidden);
    second_ = convolution_from(weights, "graphsage.conv2", dimensions_.hidden, dimensions_.output);
    decoder_weight_ = transposed(weights.tensor("nn.fc1.weight", {dimensions_.hidden, dimensions_.output}));
    decoder_bias_ = padded_vector(weights.tensor("nn.fc1.bias", {dimensions_.hidden}));
    output_weight_ = padded_vector(weights.tensor("nn.fc2.weight", {1, dimensions_.hidden}));
    output_bias_ = weights.tensor("nn.fc2.bias", {1}).values.front();
    weights.require_tensors(10);
}

GraphSageNet::Convolution GraphSageNet::convolution_from(const Weights& weights, const std::string& name,
                                                         std::uint32_t inputs, std::uint32_t outputs) {
    return {transposed(weights.tensor(name + ".lin_l.weight", {outputs, inputs})),
            transposed(weights.tensor(name + ".lin_r.weight", {outputs, inputs})),
            padded_vector(weights.tensor(name + ".lin_l.bias", {outputs})), inputs, outputs};
}

std::size_t GraphSageNet::embedding_stride() const {
    return detail::padded(dimensions_.output);
}

void GraphSageNet::convolve(const Convolution& convolution, std::span<const float> rows,
                            const MessageGraph& graph, std::vector<float>& result) {
    detail::ConvolutionTask task;
    task.rows = rows.data();
    task.row_stride = detail::padded(convolution.inputs);
    task.row_count = graph.first.size() - 1;
    task.first = graph.first.data();
    task.source = graph.source.data();
    task.neighbour = convolution.neighbour.data();
    task.own = convolution.own.data();
    task.bias = convolution.bias.data();
    task.inputs = convolution.inputs;
    task.output_stride = detail::padded(convolution.outputs);
    mean_.resize(task.row_stride);
    result.resize(task.row_count * task.output_stride);
    task.mean = mean_.data();
    task.result = result.data();
    kernel_ == Kernel::avx2 ? detail::convolve_avx2(task) : detail::convolve_scalar(task);
}

void GraphSageNet::decode(std::span<const RowPair> pairs, std::vector<float>& logits) {
    static_assert(sizeof(RowPair) == 2 * sizeof(std::uint32_t));
    logits.resize(pairs.size());
    if (pairs.empty()) return;
    detail::DecoderTask task;
    task.embeddings = embeddings_.data();
    task.embedding_stride = embedding_stride();
    task.embedding_width = dimensions_.output;
    task.pairs = &pairs.front().left;
    task.pair_count = pairs.size();
    task.weight = decoder_weight_.data();
    task.bias = decoder_bias_.data();
    task.output_weight = output_weight_.data();
    task.output_bias = output_bias_;
    task.hidden_stride = detail::padded(dimensions_.hidden);
    task.logits = logits.data();
    kernel_ == Kernel::avx2 ? detail::decode_avx2(task) : detail::decode_scalar(task);
}

void GraphSageNet::logits(std::span<const float> features, const MessageGraph& graph,
                          std::span<const RowPair> pairs, std::vector<float>& logits) {
    assert(features.size() == (graph.first.size() - 1) * dimensions_.input);
    pad_rows(features, dimensions_.input, padded_);
    convolve(first_, padded_, graph, hidden_);
    convolve(second_, hidden_, graph, embeddings_);
    decode(pairs, logits);
}

float probability_from_logit(float logit) {
    return 1.0F / (1.0F + std::exp(-logit));
}

}  // namespace clearway::prediction
