#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "links/link_run.hpp"
#include "links/link_scores.hpp"
#include "links/place_errors.hpp"
#include "metrics/link_comparison.hpp"
#include "metrics/true_links.hpp"
#include "prediction/predictor.hpp"
#include "sensing/sensor.hpp"
#include "trace/step_listener.hpp"
#include "traffic/belief.hpp"

namespace clearway::links {

/// What there is to find at one step: true links, the vehicles ahead of an emergency vehicle, and the next
/// one in a lane. Keeps its buffers.
class LinkTruthView {
  public:
    /// `network` outlives the view.
    LinkTruthView(const roads::Network& network, const graph::LinkRules& rules);
    void look(const truth::Snapshot& snapshot, const traffic::Roster& roster);

    const metrics::TrueLinks& links() const { return links_; }
    /// Links between an emergency vehicle (`left`) and one ahead on its route within the link radius.
    const std::vector<prediction::RowPair>& policy_links() const { return policy_links_; }
    /// An emergency or automated vehicle, and the next vehicle ahead in its lane.
    struct NextAhead {
        core::VehicleIndex row = 0;
        core::VehicleIndex next = core::no_row;  ///< `core::no_row` if there is none (LaneOrder).
    };
    /// One for each emergency and automated vehicle on the road.
    const std::vector<NextAhead>& next_ahead() const { return next_ahead_; }

  private:
    void find_next_ahead(const truth::Snapshot& snapshot);

    const roads::Network& network_;
    metrics::TrueLinks links_;
    std::vector<prediction::RowPair> policy_links_;
    LaneOrder lanes_;
    std::vector<NextAhead> next_ahead_;
};

/// One sensor, and the predictors that use its observations.
class LinkTrial {
  public:
    struct Setup {
        std::string failure;
        Exits exits = Exits::known;
        std::unique_ptr<sensing::SensorModel> sensor;
        std::vector<std::unique_ptr<prediction::Predictor>> predictors;
    };
    /// `network` outlives the trial.
    LinkTrial(const roads::Network& network, const graph::LinkRules& rules, Setup setup);

    void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    /// Whether a report round took place at the last `observe`.
    bool has_report() const { return observation_.is_report; }
    /// Asks every predictor, and scores the answers when `scored`; otherwise they only warm up.
    void ask(const truth::Snapshot& snapshot, const LinkTruthView& truth, bool scored);

    /// Result of predictor number `predictor` so far.
    LinkCase result(std::size_t predictor) const;
    LinkTiming::Case timing(std::size_t predictor) const;

  private:
    struct Contestant {
        std::unique_ptr<prediction::Predictor> predictor;
        traffic::BelievedGraph belief;
        LinkScores scores;
        LinkBelief counts;
        PlaceHistogram places;
        double predict_s = 0.0;
    };
    void describe_candidates(const prediction::Scene& scene, const LinkTruthView& truth);
    bool is_ahead_of_emergency(const prediction::Tracks& tracks, prediction::RowPair pair) const;
    bool truly_linked(prediction::RowPair pair, const LinkTruthView& truth) const;
    void count_truth(const truth::Snapshot& snapshot, const prediction::Scene& scene,
                     const LinkTruthView& truth);
    void find_heard(const truth::Snapshot& snapshot);
    void score(Contestant& contestant) const;
    void count_belief(Contestant& contestant, const truth::Snapshot& snapshot, const LinkTruthView& truth);
    void count_dark(Contestant& contestant, const truth::Snapshot& snapshot) const;
    void count_next_ahead(Contestant& contestant, const LinkTruthView& truth);
    bool was_heard(core::VehicleKey key) const;

    const roads::Network& network_;
    graph::LinkRules rules_;
    std::string failure_;
    Exits exits_;
    std::unique_ptr<sensing::SensorModel> sensor_;
    traffic::Observation observation_;
    sensing::FailureLog log_;
    std::vector<Contestant> contestants_;
    LinkTruth truth_;
    std::uint64_t observed_vehicles_ = 0;

    std::vector<core::VehicleIndex> true_row_;  ///< By row of the tracks; `core::no_row` when it has left.
    std::vector<std::uint8_t> label_;           ///< By candidate.
    std::vector<PairTraits> traits_;            ///< By candidate.
    metrics::BeliefMatch match_;
    std::vector<core::VehicleKey> heard_keys_;  ///< Fresh ones, ascending.
    std::vector<core::VehicleIndex> heard_;     ///< By row of the snapshot; `core::no_row` if dark.
    LaneOrder believed_lanes_;
};

/// Evaluates predictors on the reports of a run, with one trial per failure and exits. Scores at most once
/// per second.
class LinkEvaluator : public trace::StepListener {
  public:
    /// `network` outlives the evaluator. Scores from `score_from` on; before that, sensors and predictors
    /// warm up.
    LinkEvaluator(const roads::Network& network, const graph::LinkRules& rules, core::Seconds score_from);
    void add(LinkTrial::Setup setup);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    const std::vector<LinkTrial>& trials() const { return trials_; }

  private:
    const roads::Network& network_;
    graph::LinkRules rules_;
    LinkTruthView truth_;
    std::vector<LinkTrial> trials_;
    std::vector<double> next_s_;  ///< By trial.
    double score_from_s_;
};

}  // namespace clearway::links
