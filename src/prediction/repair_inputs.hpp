#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/proximity.hpp"
#include "prediction/candidates.hpp"
#include "prediction/motion_context.hpp"
#include "prediction/repair_schema.hpp"

namespace clearway::prediction {

// Computes what repair_schema.hpp lists. Training and inference call the same functions.

/// Messages come from at most this many vehicles nearest to the believed place, within the distance; leader,
/// follower and detecting vehicles come on top.
inline constexpr std::size_t most_near_sources = 10;
inline constexpr double message_radius_m = 80.0;

/// A vehicle that is not known, whose position the net corrects: its displacement by its twin, or by the
/// route rule where it has none, and the path along which the net may move it.
struct Receiver {
    std::uint32_t row = 0;
    float displacement_m = 0.0F;  ///< Before the correction.
    float reach_m = 0.0F;
    Path path;
};

/// What the net is given of one scene.
struct RepairInputs {
    std::uint32_t rows = 0;
    float radius_m = 0.0F;             ///< Of links.
    std::vector<float> nodes;          ///< rows x node_width.
    std::vector<float> x_m, y_m;       ///< Of each row, dead-reckoned: the place of those that are known.
    std::vector<float> place_sigma_m;  ///< Standard deviation of where each row was last seen, filtered.
    std::vector<Receiver> receivers;   ///< By row.
    std::vector<std::uint32_t> first_edge = {0};  ///< CSR by receiver.
    std::vector<std::uint32_t> source;            ///< Rows.
    std::vector<float> edges;                     ///< source.size() x edge_width.
    std::vector<RowPair> pairs;                   ///< The candidates.
    std::vector<float> pair_features;             ///< pairs.size() x pair_width.

    void clear();
};

/// The pair with its first end (`pair_inputs`) as `left`. Equal numbers make equal ends, whichever comes
/// first.
RowPair first_end_first(const RepairInputs& inputs, RowPair pair);

/// Makes inputs of scenes. One builder, one thread; no allocation once buffers have grown.
class RepairInputBuilder {
  public:
    /// `network` outlives the builder.
    RepairInputBuilder(const roads::Network& network, const graph::LinkRules& rules);

    /// Call it with every observation, in order, because it keeps state (see MotionContextBuilder). The scene
    /// has twins.
    void build(const traffic::Observation& observation, const Scene& scene, RepairInputs& inputs);
    /// Call it instead of `build` when the inputs are not needed: only updates the state.
    void remember(const traffic::Observation& observation, const Scene& scene) {
        roads_.build(observation, scene, ahead_);
    }
    /// Of the last call.
    const std::vector<MotionContext>& ahead() const { return ahead_; }

  private:
    void write_nodes(const traffic::Observation& observation, const Scene& scene, RepairInputs& inputs);
    void write_motion(const Scene& scene, const MotionContext& ahead, NetInputRow& row) const;
    void write_neighbours(const traffic::Observation& observation, const Scene& scene,
                          const MotionContext& ahead, NetInputRow& row) const;
    void place_rows(const Scene& scene);
    void look_around(const traffic::Observation& observation, const Scene& scene);
    void write_twin(const Scene& scene, std::size_t entry, NetInputRow& row) const;
    void write_edges(const Scene& scene, RepairInputs& inputs);
    static bool detects(std::span<const detail::Detection> detections, std::uint32_t source);
    void add_nearest(const Scene& scene, std::size_t entry, std::span<const detail::Detection> detections,
                     RepairInputs& inputs);
    void add_edge(const Scene& scene, std::size_t entry, std::uint32_t source, float range_m,
                  RepairInputs& inputs);
    /// Returns the distance of both, m.
    float write_place(std::size_t entry, std::uint32_t source, NetInputRow& out) const;
    void write_pairs(const Scene& scene, RepairInputs& inputs);
    void write_twins(RowPair pair, NetInputRow& out) const;
    void write_meeting(RowPair ends, NetInputRow& out) const;
    /// Whether `other` is leader or follower of `one`.
    bool follows(std::uint32_t one, std::uint32_t other) const;

    const roads::Network& network_;
    graph::LinkRules rules_;
    MotionContextBuilder roads_;
    graph::ProximityBuilder proximity_;
    graph::ProximityGraph near_;
    std::vector<MotionContext> ahead_;
    std::vector<std::uint32_t> ahead_of_row_;
    std::vector<TwinTraffic::Surroundings> around_;  ///< By entry of `ahead_`.
    std::vector<roads::Point> along_;  ///< By entry: direction of travel where it is believed to be.
    /// By entry: leaders and followers, those of the twin included.
    std::vector<std::vector<std::uint32_t>> beside_;
    // Of each row, as believed by twins, and by the rule where there are none.
    std::vector<float> x_m_, y_m_, sigma_m_, growth_, lane_position_m_;
    std::vector<core::LaneIndex> lane_;
    std::vector<float> rule_x_m_, rule_y_m_;
    std::vector<float> heading_cosine_, heading_sine_;  ///< Of each row, as reported.
    struct Near {
        float distance_m = 0.0F;
        std::uint32_t row = 0;
        auto operator<=>(const Near&) const = default;
    };
    std::vector<Near> nearest_;
};

}  // namespace clearway::prediction
