#pragma once

#include <vector>

#include "prediction/candidates.hpp"
#include "prediction/kinematic.hpp"
#include "prediction/motion_context.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction::detail {

/// What a predictor believes about one row of the tracks.
struct RowBelief {
    traffic::MotionState state;
    float sigma_m = 0.0F;
    bool present = true;  ///< False: left out of the belief with all its links.
};

/// Every vehicle where it was last seen, with held_sigma_m of kinematic.hpp.
void believe_last_seen(const Tracks& tracks, std::vector<RowBelief>& beliefs,
                       const LastSeenConfig& config = {});
/// Dead-reckoned states with the sigma of kinematic.hpp; those that have left (Tracks) are absent.
void believe_dead_reckoned(const Tracks& tracks, std::vector<RowBelief>& beliefs,
                           const DeadReckoningConfig& config = {});
/// Frame of every predictor that judges vehicles one by one and candidates pair by pair: builds the scene,
/// asks the derived class for both, and writes the believed graph. Known pairs are linked when their
/// *believed* distance is below the link radius, detected pairs always, candidates from the threshold up.
class PairwisePredictor : public Predictor {
  public:
    /// What a predictor needs in its scenes besides candidates.
    enum class Needs : std::uint8_t { reports, twins };
    explicit PairwisePredictor(const PredictorContext& context, Needs needs = Needs::reports);

    void predict(const traffic::Observation& observation, traffic::BelievedGraph& belief, Want want) final;
    CandidateScores scores() const final;

  protected:
    const roads::Network& network() const { return network_; }
    const graph::LinkRules& rules() const { return rules_; }
    /// What the scene was built from; only within `believe` and `score`.
    const traffic::Observation& observation() const { return *observation_; }

    /// Writes `probability(at)` of each candidate whose ends are both present.
    template <class Probability>
    static void score_present(const Scene& scene, const std::vector<RowBelief>& beliefs,
                              std::vector<float>& probabilities, const Probability& probability) {
        for (std::size_t at = 0; at < scene.candidates.size(); ++at) {
            const RowPair pair = scene.candidates.rows[at];
            if (beliefs[pair.left].present && beliefs[pair.right].present)
                probabilities[at] = probability(at);
        }
    }

    /// The same by the distance of the believed places: P(d < link radius) of kinematic.hpp.
    void score_by_place(const Scene& scene, const std::vector<RowBelief>& beliefs,
                        std::vector<float>& probabilities) const;
    /// The same by distances of the candidates.
    void score_by_distance(const Scene& scene, const std::vector<RowBelief>& beliefs,
                           const std::vector<float>& distances_m, std::vector<float>& probabilities) const;

    /// Where a vehicle that is not known is believed to be.
    struct Moved {
        float displacement_m = 0.0F;  ///< From where it was last seen, along its route.
        float sigma_m = 0.0F;
        bool has_left = false;
    };
    /// Believes known vehicles where they are, and those of `ahead` where `moved(entry)` says.
    template <class Where>
    void believe_ahead(const Tracks& tracks, const std::vector<MotionContext>& ahead,
                       std::vector<RowBelief>& beliefs, const Where& moved) const {
        for (std::size_t row = 0; row < tracks.size(); ++row)
            beliefs[row] = {tracks.state[row], tracks.sensor_sigma_m[row], true};
        for (const MotionContext& entry : ahead) {
            const Moved to = moved(entry);
            beliefs[entry.row] = {state_after(network_, *observation_, tracks, entry, to.displacement_m),
                                  to.sigma_m, !to.has_left};
        }
    }

  private:
    /// Writes one belief per row; `beliefs` has the right size and default values.
    /// By default, every vehicle is where it was last seen.
    virtual void believe(const Scene& scene, std::vector<RowBelief>& beliefs) {
        believe_last_seen(scene.tracks, beliefs);
    }
    /// Writes one probability per candidate; `probabilities` has the right size and holds zeros.
    virtual void score(const Scene& scene, const std::vector<RowBelief>& beliefs,
                       std::vector<float>& probabilities) = 0;

    struct Link {
        RowPair rows;
        float distance_m = 0.0F;
        float probability = 1.0F;
    };
    void check_probabilities() const;
    void place_vehicles(traffic::BelievedGraph& belief);
    void collect_links();
    void collect_detected();
    void merge_group();
    void write_links(traffic::BelievedGraph& belief);
    float believed_distance_m(RowPair pair) const;
    bool both_present(RowPair pair) const;

    const roads::Network& network_;
    graph::LinkRules rules_;
    const traffic::Observation* observation_ = nullptr;
    float threshold_;
    SceneBuilder builder_;
    Scene scene_;
    std::vector<RowBelief> beliefs_;
    std::vector<float> probabilities_;
    std::vector<core::VehicleIndex> believed_row_;
    std::vector<Link> links_, group_, merged_;
};

}  // namespace clearway::prediction::detail
