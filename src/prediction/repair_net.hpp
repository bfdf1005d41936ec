#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prediction/detail/linear.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/repair_inputs.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

/// Sizes of the improved net.
struct RepairDimensions {
    std::uint32_t hidden = 32;     ///< Of a vehicle's row through the rounds of messages.
    std::uint32_t layers = 2;      ///< Rounds of messages.
    std::uint32_t motion = 16;     ///< Hidden width of the motion head.
    std::uint32_t embedding = 16;  ///< Of a vehicle, for the decoder.
    std::uint32_t decoder = 32;
    std::uint32_t last = 16;
    auto operator<=>(const RepairDimensions&) const = default;
};

inline constexpr const char* repair_architecture = "graphsage_repair";

// Constants of the net; training and inference share them.
/// Link radii that trainings of nets and trees take.
inline constexpr RadiusRange repair_radii{25.0, 300.0};
inline constexpr float motion_step_m = 3.0F;  ///< A vehicle is moved by (this + share x reach) x output.
inline constexpr float motion_share = 0.2F;
inline constexpr float least_sigma_m = 0.5F;
inline constexpr float side_share = 0.02F;  ///< Part of the variance along the road that acts across it.
inline constexpr std::uint32_t distance_width = 4;
/// Inputs of the decoder: product and distance of the embeddings, `pair_width` features, and distance, score,
/// P(d < r) and spread of the believed places.
constexpr std::uint32_t decoder_width(const RepairDimensions& dimensions) {
    return 2 * dimensions.embedding + std::uint32_t{pair_width} + distance_width;
}

/// Where the net believes a receiver to be.
struct BelievedMotion {
    float displacement_m = 0.0F;  ///< Within [0, reach].
    float sigma_m = 0.0F;         ///< Mean absolute error that it expects.
};

/// The improved net, `graphsage`, for inference without torch. With x the numbers of a vehicle, e those of an
/// edge, N(i) the sources of receiver i, and g(a) = 0.5 + 0.5 a / (1 + |a|):
///
// clang-format off: equations, one per line
///     h_i     = relu(W x_i + b)
///     m_i     = mean over j in N(i) of g(A h_j + B h_i + C e_ij + b) (D h_j + E e_ij + b)
///     h_i     = relu(F m_i + b + G h_i)
///     (o, p)  = W relu(W h_i + b) + b
///     s_i     = s0_i + (3 m + 0.2 reach) o
///     sigma_i = 0.5 m + (3 m + 0.2 reach) ln(1 + e^p)
///     z_i     = W h_i + b
///     logit   = MLP([z_i * z_j, |z_i - z_j|, pair features, d / 50, c / 2, Phi(c), v / 20]) + skip c
// clang-format on
///
/// The second and third line, GraphSAGE's mean aggregation (Hamilton et al. 2017) with gates, are applied
/// `layers` times and change only receivers; known vehicles keep h. s0_i is the displacement of the twin (of
/// the route rule, where there is none), s_i the corrected one along the path, clamped to the reach, and d
/// the distance of the believed places. v^2 is 1 m^2 plus the variances of both ends: of the place where each
/// was last seen, and of its displacement, projected on the line between them (a fiftieth of it acts across
/// the road). c = (r - d) / v, clamped to +-6, with the link radius r. The logit does not depend on the order
/// of a pair. A test of the training module compares the results with libtorch. Single precision; both
/// kernels give the same bits; no allocation once buffers have grown; one object, one thread.
class RepairNet {
  public:
    /// Throws core::InputError when the weights are not such a net for `repair_schema()`.
    explicit RepairNet(const Weights& weights, Kernel kernel = best_kernel());

    const RepairDimensions& dimensions() const { return dimensions_; }
    /// Writes one logit per pair and one motion per receiver. Throws core::InputError when numbers overflow,
    /// which only damaged weights do.
    void run(const RepairInputs& inputs, std::vector<float>& logits, std::vector<BelievedMotion>& motions);

  private:
    struct Layer {
        detail::Linear gate_own, gate_source, gate_edge, value_source, value_edge, out_message, out_own;
    };
    void sort_rows(const RepairInputs& inputs);
    void encode(const RepairInputs& inputs);
    void exchange(const Layer& layer, const RepairInputs& inputs);
    void move(const RepairInputs& inputs, std::vector<BelievedMotion>& motions);
    void decode(const RepairInputs& inputs, std::vector<float>& logits);
    float distance_facts(const RepairInputs& inputs, const RowPair& pair, float* facts) const;

    [[noreturn]] void refuse_result() const;

    std::string source_;
    RepairDimensions dimensions_;
    Kernel kernel_;
    detail::Linear encoder_, motion1_, motion2_, embedding_, decoder1_, decoder2_, decoder3_;
    std::vector<Layer> layers_;
    float skip_ = 0.0F;

    std::vector<std::uint32_t> receiver_rows_, known_rows_, source_rows_, pair_rows_;
    std::vector<std::uint8_t> marked_;
    std::vector<float> hidden_, own_hidden_, source_gate_, source_value_, own_gate_, message_, renewed_;
    std::vector<float> motion_hidden_, motion_out_, embeddings_;
    std::vector<float> place_x_m_, place_y_m_, direction_x_, direction_y_, sigma_m_;
    std::vector<float> block_, block1_, block2_, block3_;
};

}  // namespace clearway::prediction
