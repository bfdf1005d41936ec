#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "samples/repair_sample.hpp"

namespace clearway::training {

/// Samples of the improved net side by side as one graph without links between them. Receivers come first:
/// row i < receiver_count() is receiver i, the known vehicles follow. Index lists hold std::int64_t because
/// torch wants it.
struct RepairBatch {
    std::vector<float> nodes;                                         ///< vehicles x node_width.
    std::vector<float> x_m, y_m;                                      ///< Of each row.
    std::vector<float> place_sigma_m;                                 ///< Of each row.
    std::vector<float> path;                                          ///< receivers x path_points x 2.
    std::vector<float> displacement_m, reach_m, true_displacement_m;  ///< Of each receiver.
    std::vector<std::int64_t> edge_source;                            ///< Rows.
    std::vector<std::int64_t> edge_receiver;
    std::vector<float> edges;  ///< edges x edge_width.
    std::vector<std::int64_t> pair_left, pair_right;
    std::vector<float> pair_features;  ///< pairs x pair_width.
    std::vector<float> radius_m;       ///< Of links, one per pair.
    std::vector<float> label;          ///< 0 or 1, one per pair.
    std::vector<float> weight;         ///< In the loss, one per pair.

    std::size_t vehicle_count() const { return x_m.size(); }
    std::size_t receiver_count() const { return reach_m.size(); }
    std::size_t edge_count() const { return edge_source.size(); }
    std::size_t pair_count() const { return label.size(); }
};

/// Which edges carry messages.
enum class MessageEdges : std::uint8_t {
    believed,  ///< From vehicles near the believed place, leaders, followers and detecting vehicles.
    observed,  ///< From detecting vehicles alone: what the observed graph holds of a vehicle not heard.
};

/// Sampling of pairs by difficulty: of the pairs that the route rule is sure of (probability outside
/// [0.02, 0.98]) only the share `easy_share` is kept, by a draw of `random` keyed with time and pair, and
/// counts for all of them. 1 keeps all.
struct PairSampling {
    double easy_share = 1.0;
    core::KeyedRandom random{core::StudySeed{0}, core::Replication{0}};
};

/// How often pair `at` of the sample counts; 0: it is left out.
float weight_of(const samples::RepairSample& sample, std::size_t at, const PairSampling& sampling);

RepairBatch batch_of(std::span<const samples::RepairSample* const> samples, MessageEdges edges,
                     const PairSampling& sampling = {});

}  // namespace clearway::training
