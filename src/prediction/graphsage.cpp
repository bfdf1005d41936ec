#include "prediction/graphsage.hpp"

#include <cassert>
#include <cmath>

#include "prediction/detail/graphsage_kernel.hpp"
#include "prediction/detail/tensor_layout.hpp"

namespace clearway::prediction {
namespace {

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

GraphSageNet::GraphSageNet(const Weights& weights, const FeatureSchema& features, Kernel kernel)
    : kernel_(kernel) {
    weights.require(architecture, features);
    dimensions_ = {weights.dimension("input"), weights.dimension("hidden"), weights.dimension("output")};
    first_ = convolution_from(weights, "graphsage.conv1", features.width, dimensions_.hidden);
    second_ = convolution_from(weights, "graphsage.conv2", dimensions_.hidden, dimensions_.output);
    decoder_ = PairDecoder(weights, dimensions_.output, dimensions_.hidden, kernel);
    weights.require_tensors(10);
}

GraphSageNet::Convolution GraphSageNet::convolution_from(const Weights& weights, const std::string& name,
                                                         std::uint32_t inputs, std::uint32_t outputs) {
    return {detail::transposed(weights.tensor(name + ".lin_l.weight", {outputs, inputs})),
            detail::transposed(weights.tensor(name + ".lin_r.weight", {outputs, inputs})),
            detail::padded_vector(weights.tensor(name + ".lin_l.bias", {outputs})), inputs, outputs};
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

void GraphSageNet::logits(std::span<const float> features, const MessageGraph& graph,
                          std::span<const RowPair> pairs, std::vector<float>& logits) {
    assert(features.size() == (graph.first.size() - 1) * dimensions_.input);
    pad_rows(features, dimensions_.input, padded_);
    convolve(first_, padded_, graph, hidden_);
    convolve(second_, hidden_, graph, embeddings_);
    decoder_.logits(embeddings_, pairs, logits);
}

float probability_from_logit(float logit) {
    return 1.0F / (1.0F + std::exp(-logit));
}

}  // namespace clearway::prediction
