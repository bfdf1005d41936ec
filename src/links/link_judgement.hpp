#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/resampling.hpp"
#include "links/link_run.hpp"
#include "links/link_scores.hpp"

namespace clearway::links {

/// How well one kind of candidate pairs was predicted.
struct LinkMeasures {
    std::uint64_t pairs = 0;
    std::uint64_t true_links = 0;
    analysis::Measured ap, auc, f1, log_loss, ece;  ///< As metrics::LinkQuality.
    analysis::Measured brier;                       ///< As metrics::brier_score.
};

/// All failed links: true, and neither known nor detected by the observation. The candidates are a part of
/// them; those outside are never found.
struct LinkFailed {
    std::uint64_t links = 0;
    std::uint64_t seen = 0;                    ///< Of them: both ends have reported and are not forgotten.
    analysis::Measured candidate_recall;       ///< Share of the failed links that are candidates.
    analysis::Measured candidate_recall_seen;  ///< The same of those seen.
    analysis::Measured ap, f1;  ///< Those of all candidates, with recall over all failed links.
};

/// What is believed of dark vehicles: those on the road that were not heard just now.
struct LinkDark {
    std::uint64_t vehicles = 0;    ///< Summed over reports.
    std::uint64_t never_seen = 0;  ///< Of them: never reported, or forgotten.
    analysis::Measured believed;   ///< Share that the belief holds at all.
    /// Distance of the believed from the true place, of those believed, m.
    analysis::Measured place_median_m, place_p95_m;
    /// Cases in which the true or the believed next vehicle ahead in the lane of an emergency or automated
    /// vehicle is dark; the believed one depends on the predictor, and so does this number.
    std::uint64_t next_cases = 0;
    analysis::Measured next_ahead;  ///< Share of them in which the belief is right.
};

/// The believed graph compared with the true one, at the predictor's own link threshold. True links outside
/// the candidates, or with a vehicle never seen, are misses.
struct LinkEndToEnd {
    LinkTruth truth;
    LinkBelief belief;
    analysis::Measured precision, recall, f1;
    analysis::Measured policy_recall;  ///< Of links between an emergency vehicle and one ahead on its route.

    /// True links within reach between vehicles known of, but not listed.
    std::uint64_t predicted_away() const {
        return truth.true_links - truth.never_seen - truth.outside - belief.listed_true;
    }
    /// Mean over reports.
    std::optional<double> ghosts_per_report() const;
};

/// How one predictor performs under one failure, in one scenario or all of them pooled.
struct LinkResult {
    std::string scenario;  ///< Empty: all, pooled.
    std::string failure;
    Exits exits = Exits::known;
    std::string predictor;
    double threshold = 0.5;  ///< For F1, chosen on the validation runs of all scenarios together.
    std::array<LinkMeasures, link_subsets.size()> subsets;
    LinkFailed failed;
    LinkDark dark;
    LinkEndToEnd end_to_end;
    double report_us = 0.0;        ///< Mean wall time of one prediction.
    double report_vehicles = 0.0;  ///< Mean number in an observation.

    const LinkMeasures& of(LinkSubset subset) const { return subsets[static_cast<std::size_t>(subset)]; }
    /// Scores of the pairs, for curves; only in the pooled result.
    LinkScoreSummary scores;
};

/// Error of a predictor compared with an opponent's, pooled. A reduction of 1 means that no error is left, 0
/// no difference.
struct LinkGain {
    std::string failure;
    Exits exits = Exits::known;
    std::string predictor;
    std::string against;
    analysis::Measured ap_difference;       ///< AP minus the opponent's.
    analysis::Measured ap_error_reduction;  ///< 1 - (1 - AP) / (1 - the opponent's).
    analysis::Measured f1_error_reduction;  ///< The same with F1.
};

/// The runs of one predictor. Test runs are grouped by scenario, in the same order for all predictors.
struct LinkRuns {
    std::vector<LinkRun> test;
    std::vector<LinkTiming> test_timing;
    std::vector<LinkRun> validation;
};

/// Evaluates predictors one after the other, so that only one predictor's runs have to be in memory.
class LinkJudgement {
  public:
    /// Number of test runs of each scenario, in the order of LinkRuns::test.
    explicit LinkJudgement(const std::vector<std::size_t>& runs_by_scenario);

    /// All runs hold the same cases in the same order. Results are in the order of the calls: per call pooled
    /// first, then by scenario, each by case.
    void add(const LinkRuns& runs);
    const std::vector<LinkResult>& results() const { return results_; }
    /// Every other predictor compared with this one. Empty when this one was not added.
    std::vector<LinkGain> gains(const std::string& against) const;

  private:
    struct Draws {
        std::vector<double> ap, f1;
    };
    struct PooledCase {
        std::size_t result = 0;
        Draws draws;
    };
    /// All figures of a result but its times. Returns the draws behind the AP and F1 of all candidates.
    static Draws measure(const std::vector<const LinkCase*>& cases, const analysis::RunResampling& resampling,
                         LinkResult& result);
    void add_pooled(const LinkRuns& runs, std::size_t number, double threshold);
    void add_scenario(const LinkRuns& runs, std::size_t number, std::size_t scenario, double threshold);
    LinkGain gain(const PooledCase& one, const PooledCase& other) const;

    std::vector<std::size_t> runs_by_scenario_;
    analysis::RunResampling pooled_;
    std::vector<LinkResult> results_;
    std::vector<PooledCase> pooled_cases_;
};

}  // namespace clearway::links
