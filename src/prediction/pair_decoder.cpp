#include "prediction/pair_decoder.hpp"

#include "prediction/detail/graphsage_kernel.hpp"
#include "prediction/detail/tensor_layout.hpp"

namespace clearway::prediction {

PairDecoder::PairDecoder(const Weights& weights, std::uint32_t width, std::uint32_t hidden, Kernel kernel)
    : weight_(detail::transposed(weights.tensor("nn.fc1.weight", {hidden, width}))),
      bias_(detail::padded_vector(weights.tensor("nn.fc1.bias", {hidden}))),
      output_weight_(detail::padded_vector(weights.tensor("nn.fc2.weight", {1, hidden}))),
      output_bias_(weights.tensor("nn.fc2.bias", {1}).values.front()),
      width_(width),
      hidden_(hidden),
      kernel_(kernel) {}

void PairDecoder::logits(std::span<const float> embeddings, std::span<const RowPair> pairs,
                         std::vector<float>& logits) const {
    static_assert(sizeof(RowPair) == 2 * sizeof(std::uint32_t));
    logits.resize(pairs.size());
    if (pairs.empty()) return;
    detail::DecoderTask task;
    task.embeddings = embeddings.data();
    task.embedding_stride = detail::padded(width_);
    task.embedding_width = width_;
    task.pairs = &pairs.front().left;
    task.pair_count = pairs.size();
    task.weight = weight_.data();
    task.bias = bias_.data();
    task.output_weight = output_weight_.data();
    task.output_bias = output_bias_;
    task.hidden_stride = detail::padded(hidden_);
    task.logits = logits.data();
    kernel_ == Kernel::avx2 ? detail::decode_avx2(task) : detail::decode_scalar(task);
}

}  // namespace clearway::prediction
