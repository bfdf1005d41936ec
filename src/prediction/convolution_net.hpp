#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prediction/graphsage.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/pair_decoder.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// How rows gather what others know, where GraphSAGE takes a mean.
enum class GraphConvolution : std::uint8_t {
    gcn,  ///< Kipf and Welling 2017, equation 2.
    gat,  ///< Velickovic et al. 2018, equations 3 and 4, one head.
};

/// The dissertation's net with another convolution in the place of both SAGEConv, for inference without
/// torch. N(i) are the rows whose messages i receives, and i itself, once:
///
// clang-format off: equations, one a line
///     GCN:  h_i = sum over j in N(i) of W x_j / sqrt(|N(i)| |N(j)|) + b
///     GAT:  h_i = sum over j in N(i) of alpha_ij W x_j + b
///           alpha_ij = softmax over j in N(i) of leaky(s . W x_j + t . W x_i),  leaky(a) = max(a, a / 5)
// clang-format on
///
/// The same once more from h gives the embeddings z; the decoder is the dissertation's (pair_decoder.hpp). As
/// in its net no activation stands between the layers, so that the convolution is all that differs. Both
/// layers are GCNConv and GATConv of PyTorch Geometric with their defaults; tensors have its names below
/// `gcn.` or `gat.`: `conv1.lin.weight` (W), `conv1.bias`, and of GAT `conv1.att_src` (s), `conv1.att_dst`
/// (t) as {1, 1, outputs}. A row's message to itself is left out: it hears itself anyway. Held to libtorch by
/// a test of the training module. Single precision; no allocation once buffers have grown; one object, one
/// thread.
class ConvolutionNet {
  public:
    static const char* architecture(GraphConvolution convolution);

    /// Throws core::InputError when the weights are not such a net for `features`.
    ConvolutionNet(GraphConvolution convolution, const Weights& weights, const FeatureSchema& features);

    const GraphSageDimensions& dimensions() const { return dimensions_; }

    /// Writes one logit per pair. `features` is row-major, rows x dimensions().input. Graph and pairs refer
    /// to its rows.
    void logits(std::span<const float> features, const MessageGraph& graph, std::span<const RowPair> pairs,
                std::vector<float>& logits);

  private:
    struct Layer {
        std::vector<float> weight;            ///< [inputs][padded outputs]
        std::vector<float> bias;              ///< [padded outputs]
        std::vector<float> source_attention;  ///< [padded outputs], of GAT alone, as the next.
        std::vector<float> target_attention;
        std::uint32_t inputs = 0;
        std::uint32_t outputs = 0;
    };
    Layer layer_from(const Weights& weights, const std::string& name, std::uint32_t inputs,
                     std::uint32_t outputs) const;
    void apply(const Layer& layer, std::span<const float> rows, std::size_t row_stride,
               const MessageGraph& graph, std::vector<float>& result);
    void project(const Layer& layer, std::span<const float> rows, std::size_t row_stride, std::size_t count);
    void weigh_by_degree(const MessageGraph& graph, std::size_t row);
    void weigh_by_attention(const MessageGraph& graph, std::size_t row);

    GraphConvolution convolution_;
    GraphSageDimensions dimensions_;
    Layer first_, second_;
    PairDecoder decoder_;
    std::vector<float> projected_, hidden_, embeddings_;
    std::vector<float> share_;   ///< Of the messages of a row, itself last.
    std::vector<float> source_;  ///< Of each row: 1 / sqrt(|N|) (GCN), s . W x (GAT).
    std::vector<float> target_;  ///< Of each row: t . W x (GAT).
};

}  // namespace clearway::prediction
