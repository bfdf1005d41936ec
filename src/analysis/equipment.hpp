#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::analysis {

/// As many as a search takes: the demand of each is made before anything runs.
inline constexpr std::uint32_t most_equip_replications = 1000;

/// A set of equipped signals: numbers of candidates from 0, in the order in which they were chosen.
using SignalSet = std::vector<std::size_t>;

/// What emergency vehicles need with each of these sets in each of the first `replications`:
/// `primary_metric`, s. Nothing for a run that failed. Called once for all sets that are wanted at a time.
using MeasureSets =
    std::function<std::vector<Values>(const std::vector<SignalSet>& sets, std::size_t replications)>;

/// Which candidates are tried for the second and later places.
enum class Search : std::uint8_t {
    lazy,      ///< Those whose last marginal gain could still be the greatest.
    thorough,  ///< All, in a race as for the first place.
};

struct EquipConfig {
    std::size_t candidates = 0;
    std::size_t budget = 1;        ///< Signals to equip, at least 1.
    std::size_t replications = 2;  ///< At least 2.
    Search search = Search::lazy;
    double level = usual_level;
    /// Tried together too while two places are left: neighbours, of which one may pay only with the other.
    std::vector<std::array<std::size_t, 2>> pairs = {};
};

/// What a candidate was found to add to those chosen before.
struct EquipLaterGain {
    std::size_t ranks = 0;  ///< How many those were; 0: it was not tried beside any.
    MaybeEstimate gain = std::nullopt;
};

/// A candidate by itself, or a pair, as the first place saw it.
struct EquipCandidate {
    /// Less time than with no signal equipped, s, of a pair half of it; over fewer runs where it left the
    /// race. Nothing without runs to pair. The intervals of all hold together at the level (Bonferroni).
    MaybeEstimate gain;
    bool left_race = false;     ///< Shown to gain less than another before all replications were made.
    EquipLaterGain later = {};  ///< When it was last tried beside others, chosen then or not.
};

/// A signal that was chosen, or would have been the next.
struct EquipStep {
    std::size_t candidate = 0;
    /// Less time than without it, s, in the runs that it was chosen by: too high by the choice. Nothing
    /// without a pair of runs. Of two that were chosen together, half of what both gain.
    MaybeEstimate gain;
    std::optional<std::size_t> partner = std::nullopt;  ///< The one that was chosen together with it.
};

/// Why no further signal was chosen.
enum class EquipEnd : std::uint8_t {
    budget,     ///< As many as wanted are chosen.
    exhausted,  ///< All candidates are.
    no_gain,    ///< In the mean of its runs the next one gains nothing.
};

struct EquipPlan {
    std::vector<EquipCandidate> candidates;  ///< By number.
    std::vector<EquipCandidate> pairs;       ///< As EquipConfig has them; empty if the budget is 1.
    std::vector<EquipStep> steps;            ///< By rank.
    EquipEnd end = EquipEnd::budget;
    std::optional<EquipStep> next;  ///< With `no_gain`: the one that was not chosen.
};

/// Numbers of replications after which a race drops candidates, then all of them: 5 (`fewest_for_interval`),
/// 10, 20, ... below `replications`, then `replications`.
std::vector<std::size_t> equip_looks(std::size_t replications);

/// Chooses signals one by one, or two by two: each time the candidate or pair with the greatest mean gain a
/// signal over those chosen before, of equal ones the first, until the budget is spent, no candidate is left
/// or the next one gains nothing.
///
/// A place is filled by a race. After each look but the last, a candidate leaves if its paired difference
/// from another is shown to be for the worse: one-sided t test at (1 - level) / ((m - 1) L) for m candidates
/// and L such looks. The candidate that is truly best leaves only if one of these (m - 1) L tests against it
/// errs, so that each race keeps it with probability `level` (Bonferroni), as far as t tests hold. Those that
/// stay may still be chosen by chance: gains must be estimated again from runs that decided nothing.
///
/// The greedy choice is within 1 - 1/e of the best set if gains are submodular (Nemhauser, Wolsey and Fisher
/// 1978), and then the lazy search (Minoux 1978) finds what the thorough one finds. Gains of signals need not
/// be: a green may pay only with the next one, which is what pairs are for.
EquipPlan equip_greedily(const EquipConfig& config, const MeasureSets& measure);

/// Times of the emergency vehicles of a run, s, by id; empty for a run that failed.
using TripTimes = std::map<std::string, double>;

/// What trips gain that pass a chosen signal on their planned way, and the others.
struct GainSplit {
    std::size_t trips = 0;       ///< That both runs of a pair have.
    std::size_t passing = 0;     ///< Of them.
    MaybeEstimate passing_gain;  ///< Less time a trip, s. Weighted by trips, both add up to the gain of all.
    MaybeEstimate other_gain;
};

/// All by replication; `passing`: the ids of the emergency vehicles that pass.
GainSplit split_gain(const std::vector<TripTimes>& before, const std::vector<TripTimes>& after,
                     const std::vector<std::set<std::string>>& passing);

}  // namespace clearway::analysis
