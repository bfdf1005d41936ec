#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/spellings.hpp"
#include "prediction/detail/linear.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// How rows gather what others know: as the dissertation does, or what can stand in its place.
enum class Convolution : std::uint8_t {
    sage,  ///< GraphSAGE, Hamilton et al. 2017, with mean aggregation.
    gcn,   ///< Kipf and Welling 2017, equation 2.
    gat,   ///< Velickovic et al. 2018, equations 3 and 4, one head.
};
constexpr core::Spellings<Convolution, 3> spellings(Convolution) {
    return {{{Convolution::sage, "sage"}, {Convolution::gcn, "gcn"}, {Convolution::gat, "gat"}}};
}

/// Sizes of the dissertation's net; hidden 10 and output 5 there.
struct NetDimensions {
    std::uint32_t input = 2;
    std::uint32_t hidden = 10;
    std::uint32_t output = 5;
    auto operator<=>(const NetDimensions&) const = default;
};

/// The dissertation's GraphSAGENet (chapters 5.1 and 5.2), for inference without torch:
///
// clang-format off: equations, one per line
///     h_i      = W1l mean_{j -> i} x_j + b1 + W1r x_i
///     z_i      = W2l mean_{j -> i} h_j + b2 + W2r h_i
///     logit_ij = w4 . relu(W3 (z_i * z_j) + b3) + b4
// clang-format on
///
/// Two SAGEConv, as published without an activation between them; z_i * z_j is the elementwise product. A row
/// that receives no messages has mean 0. To compare, both layers can be another convolution. N(i) are then
/// the rows whose messages i receives, and i itself, once (its messages to itself are left out):
///
// clang-format off: equations, one a line
///     GCN:  h_i = sum over j in N(i) of W x_j / sqrt(|N(i)| |N(j)|) + b
///     GAT:  h_i = sum over j in N(i) of alpha_ij W x_j + b
///           alpha_ij = softmax over j in N(i) of leaky(s . W x_j + t . W x_i),  leaky(a) = max(a, a / 5)
// clang-format on
///
/// Layers are SAGEConv, GCNConv and GATConv of PyTorch Geometric with their defaults, and tensors have its
/// names
/// (`parameter_names`): `lin_l` W1l and b1, `lin_r` W1r, `lin` W, `att_src` s and `att_dst` t as {1, 1,
/// outputs}, `nn.fc1` W3 and b3, `nn.fc2` w4 and b4. A test of the training module compares the results with
/// libtorch. Single precision; both kernels give the same bits; no allocation once buffers have grown; one
/// object, one thread.
class DissertationNet {
  public:
    /// Throws core::InputError when the weights are not such a net for `features`.
    DissertationNet(Convolution convolution, const Weights& weights, const FeatureSchema& features,
                    Kernel kernel = best_kernel());
    const NetDimensions& dimensions() const { return dimensions_; }

    /// Writes one logit per pair. `features` is row-major, rows x dimensions().input. Graph and pairs refer
    /// to its rows.
    void logits(std::span<const float> features, const MessageGraph& graph, std::span<const RowPair> pairs,
                std::vector<float>& logits);
    /// The embeddings z of the last call to `logits`, row-major, rows x embedding_stride(); the first
    /// dimensions().output numbers of a row are used.
    std::span<const float> embeddings() const { return embeddings_; }
    std::size_t embedding_stride() const { return detail::padded(dimensions_.output); }

  private:
    struct Layer {
        /// Of SAGE: W1l and W1r by turns, for inputs (mean, own) by turns. Of the others W, without a bias.
        detail::Linear linear;
        std::vector<float> bias;  ///< [padded outputs], as the next; of GCN and GAT.
        std::vector<float> source_attention, target_attention;  ///< Of GAT.
        std::uint32_t inputs = 0;
    };
    Layer layer_from(const Weights& weights, const std::string& name, std::uint32_t inputs,
                     std::uint32_t outputs) const;
    void apply(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
               const MessageGraph& graph, std::vector<float>& result);
    void apply_mean(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
                    const MessageGraph& graph, std::vector<float>& result);
    void project(const Layer& layer, std::span<const float> rows, std::size_t row_stride, std::size_t count);
    void count_degrees(const MessageGraph& graph);
    void weigh_by_degree(const MessageGraph& graph, std::size_t row);
    void weigh_by_attention(const MessageGraph& graph, std::size_t row);
    void decode(std::span<const RowPair> pairs, std::vector<float>& logits);

    Convolution convolution_;
    NetDimensions dimensions_;
    Kernel kernel_;
    Layer first_, second_;
    detail::Linear decoder_;
    std::vector<float> output_weight_;
    float output_bias_ = 0.0F;
    std::vector<float> gathered_;  ///< Of SAGE: mean and own inputs of each row by turns.
    std::vector<float> projected_, hidden_, embeddings_, products_, decoded_;
    std::vector<float> share_;   ///< Of the messages of a row, itself last.
    std::vector<float> source_;  ///< Of each row: 1 / sqrt(|N|) (GCN), s . W x (GAT).
    std::vector<float> target_;  ///< Of each row: t . W x (GAT).
};

/// Names of the net's tensors in the order of Python's `state_dict()`: those of the first convolution, those
/// of the second, and of the decoder.
std::vector<std::string> parameter_names(Convolution convolution);
/// The net of these tensors as a model file.
Weights net_weights(Convolution convolution, const FeatureSchema& features, const NetDimensions& dimensions,
                    std::vector<Tensor> tensors);

}  // namespace clearway::prediction
