#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/spellings.hpp"
#include "graph/proximity.hpp"
#include "prediction/net_rows.hpp"
#include "prediction/tracks.hpp"
#include "prediction/twin_traffic.hpp"
#include "traffic/observation.hpp"

namespace clearway::prediction {

/// Pairs of rows of a `Tracks`, left < right, ordered by (left, right), with both distances.
struct PairList {
    std::vector<RowPair> rows;
    std::vector<float> last_seen_m;      ///< Distance of the last reported positions, m.
    std::vector<float> dead_reckoned_m;  ///< Distance of the dead-reckoned positions, m.

    std::size_t size() const { return rows.size(); }
    void clear();
    void add(RowPair pair, float last_seen_distance_m, float dead_reckoned_distance_m);
};

/// What any predictor starts from: tracks, and the allowed pairs in three groups that do not overlap.
struct Scene {
    Tracks tracks;
    PairList known;     ///< Both ends known, and within the link radius by one of the two distances.
    PairList detected;  ///< One end still detects the other: linked wherever the ends are believed to be.
    std::vector<float> detected_range_m;  ///< One per detected pair; negative when only presence is known.
    PairList candidates;                  ///< To be predicted.
    const TwinTraffic* twins = nullptr;   ///< Of the builder; null where it has none.
};

/// The candidate rule, the same for every predictor and independent of it: a pair of classes that may be
/// linked, with at least one end not known, no detection between them, and not further apart than
/// `candidate_reach_m` by one of the places that the reach names. True links outside it are misses of every
/// predictor.
enum class CandidateReach : std::uint8_t {
    reported,  ///< Last seen, dead-reckoned.
    twins,     ///< These, and the places of car-following twins (TwinTraffic).
};
constexpr core::Spellings<CandidateReach, 2> spellings(CandidateReach) {
    return {{{CandidateReach::reported, "reported"}, {CandidateReach::twins, "twins"}}};
}

/// So much further than the link radius candidates reach. (70 m: in the measured traffic, 1 in 1000 pairs
/// beyond 120 m was linked within 50 m.)
inline constexpr double candidate_margin_m = 70.0;
inline constexpr double least_candidate_reach_m = 120.0;
constexpr double candidate_reach_m(const graph::LinkRules& rules) {
    return std::max(least_candidate_reach_m, rules.radius_m + candidate_margin_m);
}

/// What somebody reads of a belief. Without links, places cost the same state and give the same numbers.
enum class Want : std::uint8_t { places, links };

/// Builds scenes. O(vehicles + pairs); no allocation once buffers have grown; one builder, one thread.
class SceneBuilder {
  public:
    /// `network` outlives the builder. Without twins, scenes have none and candidates are those of
    /// CandidateReach::reported.
    SceneBuilder(const roads::Network& network, const graph::LinkRules& rules);
    /// The builder outlives its scenes: it drives their twins.
    SceneBuilder(const roads::Network& network, const graph::LinkRules& rules, CandidateReach reach);
    /// Where only places are wanted, scenes have neither candidates nor known pairs.
    void build(const traffic::Observation& observation, Scene& scene, Want want = Want::links);

  private:
    void collect_detected(const traffic::Observation& observation, Scene& scene);
    void sort_pairs(Scene& scene);
    void take(RowPair pair, Scene& scene) const;
    void place_twins(const Tracks& tracks);

    const roads::Network& network_;
    graph::LinkRules rules_;
    CandidateReach reach_;
    std::optional<TwinTraffic> twins_;
    graph::ProximityBuilder builder_;
    graph::ProximityGraph near_last_, near_now_, near_twins_;
    std::vector<float> twin_x_m_, twin_y_m_;
    struct Detection {
        RowPair rows;
        float range_m = -1.0F;
        auto operator<=>(const Detection&) const = default;
    };
    std::vector<Detection> detections_;
};

/// Messages of the observed graph: along every known link, by dead-reckoned distance, and every detected one,
/// both ways.
class ObservedMessages {
  public:
    void build(const Scene& scene, const graph::LinkRules& rules, MessageGraph& graph);

  private:
    std::vector<std::uint32_t> sources_, targets_;
};

}  // namespace clearway::prediction
