#include "trace/replay.hpp"

#include <cassert>

#include <fmt/format.h>

#include "experiment/settings.hpp"
#include "metrics/recorder.hpp"
#include "metrics/true_links.hpp"
#include "pipeline/decision_chain.hpp"
#include "trace/difference.hpp"

namespace clearway::trace {
namespace {

/// Scores beliefs against the truth of their moment.
class Scorer {
  public:
    void decision(const truth::Snapshot& snapshot, const metrics::TrueLinks* truth,
                  const traffic::BelievedGraph& belief, std::size_t leases) {
        ++score_.decisions;
        score_.leases += leases;
        if (truth == nullptr) return;
        ++score_.scored;
        recorder_.links(snapshot, *truth, belief);
    }
    LinkScore score() const {
        LinkScore score = score_;
        score.links = recorder_.link_counts();
        score.dark = recorder_.dark_link_counts();
        return score;
    }

  private:
    metrics::Recorder recorder_;
    LinkScore score_;
};

/// Collects a predictor's probability of every candidate, and the truth.
class CandidateGatherer {
  public:
    void add(const truth::Snapshot& snapshot, const metrics::TrueLinks& truth,
             const prediction::CandidateScores& scores) {
        core::match_rows(scores.scene->tracks.key, snapshot.key, true_row_);
        assert(scores.probability.size() <= scores.scene->candidates.rows.size());
        for (std::size_t at = 0; at < scores.probability.size(); ++at) {
            const prediction::RowPair pair = scores.scene->candidates.rows[at];
            probability_.push_back(scores.probability[at]);
            linked_.push_back(truth.linked(true_row_[pair.left], true_row_[pair.right]) ? 1 : 0);
        }
    }
    metrics::LinkQuality quality() const { return metrics::link_quality({probability_, linked_}); }

  private:
    std::vector<core::VehicleIndex> true_row_;
    std::vector<double> probability_;
    std::vector<std::uint8_t> linked_;
};

struct Roads {
    const roads::Network& network;
    const std::vector<double>& mean_times_s;
};

class Replay {
  public:
    Replay(const RecordingInfo& info, const experiment::ConditionSpec& condition, const Roads& roads,
           const experiment::LoopConfig& loop)
        : chain_(condition, {.network = roads.network,
                             .random = core::KeyedRandom(core::StudySeed{info.provenance.study_seed},
                                                         core::Replication{info.key.replication}),
                             .policy_period_s = loop.policy_period_s,
                             .rules = loop.rules(),
                             .incidents = incidents_from(info.incidents, "recording"),
                             .mean_times_s = roads.mean_times_s}),
          true_links_(loop.rules()) {}

    void step(const RecordedStep& step) {
        const truth::Snapshot& snapshot = *step.snapshot;
        if (result_.steps++ == 0) result_.begin_s = snapshot.time.value;
        result_.end_s = snapshot.time.value;
        result_.vehicle_steps += snapshot.size();
        has_looked_ = false;

        chain_.observe(snapshot, *step.roster);
        const bool decides = chain_.decision_is_due();
        if (decides) decide(snapshot);
        if (step.belief != nullptr)
            recorded_.decision(snapshot, truth_if(step.observation->is_report, snapshot), *step.belief,
                               step.leases.size());
        compare(step, decides);
    }

    ReplayResult result() {
        result_.recorded = recorded_.score();
        result_.replayed = replayed_.score();
        result_.candidates = candidates_.quality();
        return result_;
    }

  private:
    void decide(const truth::Snapshot& snapshot) {
        chain_.decide();
        const metrics::TrueLinks* const truth = truth_if(chain_.observation().is_report, snapshot);
        replayed_.decision(snapshot, truth, chain_.belief(), chain_.leases().size());
        if (truth != nullptr) candidates_.add(snapshot, *truth, chain_.predictor().scores());
    }

    const metrics::TrueLinks* truth_if(bool wanted, const truth::Snapshot& snapshot) {
        if (!wanted) return nullptr;
        if (!has_looked_) true_links_.look(snapshot);
        has_looked_ = true;
        return &true_links_;
    }

    void compare(const RecordedStep& step, bool decided) {
        const double time_s = step.snapshot->time.value;
        if (step.observation != nullptr)
            note(result_.observations, time_s, difference(*step.observation, chain_.observation()));
        if (step.belief == nullptr) return;
        if (!decided) {
            note(result_.beliefs, time_s, "a decision was recorded where none is due");
            return;
        }
        note(result_.beliefs, time_s, difference(*step.belief, chain_.belief()));
        note(result_.leases, time_s, difference(step.leases, chain_.leases()));
    }

    static void note(Agreement& agreement, double time_s, const std::optional<std::string>& difference) {
        ++agreement.compared;
        if (!difference) {
            ++agreement.same;
        } else if (agreement.first_difference.empty()) {
            agreement.first_difference = fmt::format("at {} s: {}", time_s, *difference);
        }
    }

    pipeline::DecisionChain chain_;
    metrics::TrueLinks true_links_;
    bool has_looked_ = false;  ///< Whether `true_links_` is that of the present step.
    Scorer recorded_, replayed_;
    CandidateGatherer candidates_;
    ReplayResult result_;
};

}  // namespace

ReplayResult replay(RecordingReader& recording, const experiment::ConditionSpec& condition,
                    const roads::Network& network, const std::vector<double>& mean_times_s) {
    const experiment::LoopConfig loop = experiment::loop_config(condition, loop_of(recording.info()));
    Replay replay(recording.info(), condition, {network, mean_times_s}, loop);
    while (const auto step = recording.next())
        replay.step(*step);
    return replay.result();
}

}  // namespace clearway::trace
