#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prediction/net_rows.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// What the dissertation's net makes of the embeddings of a pair (chapter 5.1, LinkPredictionNN):
/// logit_ij = w4 . relu(W3 (z_i * z_j) + b3) + b4. Tensors `nn.fc1.weight` (W3), `.bias`, `nn.fc2.weight`,
/// `.bias`.
class PairDecoder {
  public:
    PairDecoder() = default;
    /// `width`: of an embedding. Throws core::InputError when the tensors are missing or shaped otherwise.
    PairDecoder(const Weights& weights, std::uint32_t width, std::uint32_t hidden, Kernel kernel);

    /// One logit a pair. `embeddings` are row-major, a row every `padded(width)` floats.
    void logits(std::span<const float> embeddings, std::span<const RowPair> pairs,
                std::vector<float>& logits) const;

  private:
    std::vector<float> weight_, bias_, output_weight_;
    float output_bias_ = 0.0F;
    std::uint32_t width_ = 0;
    std::uint32_t hidden_ = 0;
    Kernel kernel_ = Kernel::scalar;
};

}  // namespace clearway::prediction
