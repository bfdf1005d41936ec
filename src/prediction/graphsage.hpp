#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prediction/net_rows.hpp"
#include "prediction/pair_decoder.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// Sizes of the dissertation's net; hidden 10 and output 5 there.
struct GraphSageDimensions {
    std::uint32_t input = 2;
    std::uint32_t hidden = 10;
    std::uint32_t output = 5;
    auto operator<=>(const GraphSageDimensions&) const = default;
};

/// The dissertation's GraphSAGENet (chapters 5.1 and 5.2), for inference without torch:
///
// clang-format off: equations, one per line
///     h_i      = W1l mean_{j -> i} x_j + b1 + W1r x_i
///     z_i      = W2l mean_{j -> i} h_j + b2 + W2r h_i
///     logit_ij = w4 . relu(W3 (z_i * z_j) + b3) + b4
// clang-format on
///
/// Two SAGEConv with mean aggregation (Hamilton et al. 2017), as published without an activation between
/// them; z_i * z_j is the elementwise product. A row that receives no messages has mean 0. Tensors have
/// PyTorch Geometric's names: `graphsage.conv1.lin_l.weight` (W1l), `.lin_l.bias`, `.lin_r.weight`,
/// `graphsage.conv2...`, `nn.fc1.weight`, `nn.fc1.bias`, `nn.fc2.weight`, `nn.fc2.bias`. A test of the
/// training module compares the results with libtorch. Single precision; no allocation once buffers have
/// grown; one object, one thread.
class GraphSageNet {
  public:
    static constexpr const char* architecture = "graphsage_net";

    /// Throws core::InputError when the weights are not such a net for `features`.
    GraphSageNet(const Weights& weights, const FeatureSchema& features, Kernel kernel = best_kernel());

    const GraphSageDimensions& dimensions() const { return dimensions_; }

    /// Writes one logit per pair. `features` is row-major, rows x dimensions().input. Graph and pairs refer
    /// to its rows.
    void logits(std::span<const float> features, const MessageGraph& graph, std::span<const RowPair> pairs,
                std::vector<float>& logits);
    /// The embeddings z of the last call to `logits`, row-major, rows x embedding_stride(); the first
    /// dimensions().output numbers of a row are used.
    std::span<const float> embeddings() const { return embeddings_; }
    std::size_t embedding_stride() const;

  private:
    struct Convolution {
        std::vector<float> neighbour;  ///< [inputs][padded outputs]
        std::vector<float> own;        ///< [inputs][padded outputs]
        std::vector<float> bias;       ///< [padded outputs]
        std::uint32_t inputs = 0;
        std::uint32_t outputs = 0;
    };
    static Convolution convolution_from(const Weights& weights, const std::string& name, std::uint32_t inputs,
                                        std::uint32_t outputs);
    void convolve(const Convolution& convolution, std::span<const float> rows, const MessageGraph& graph,
                  std::vector<float>& result);

    GraphSageDimensions dimensions_;
    Kernel kernel_;
    Convolution first_, second_;
    PairDecoder decoder_;
    std::vector<float> padded_, hidden_, embeddings_, mean_;
};

/// The logistic function: the probability for a logit.
float probability_from_logit(float logit);

}  // namespace clearway::prediction
