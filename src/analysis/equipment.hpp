#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/summary.hpp"

namespace clearway::analysis {

/// A set of equipped signals: numbers of candidates from 0, in the order in which they were chosen.
using SignalSet = std::vector<std::size_t>;

/// What emergency vehicles need with each of these sets, by replication: `primary_metric`, s. Nothing for a
/// run that failed. Called once for all sets that are wanted at a time.
using MeasureSets = std::function<std::vector<Values>(const std::vector<SignalSet>& sets)>;

/// Which candidates are tried for the second and later places.
enum class Search : std::uint8_t {
    lazy,      ///< Those whose last marginal gain could still be the greatest.
    thorough,  ///< All.
};

struct EquipConfig {
    std::size_t candidates = 0;
    std::size_t budget = 1;  ///< Signals to equip, at least 1.
    Search search = Search::lazy;
    double level = usual_level;
};

/// A signal that was chosen, or would have been the next.
struct EquipStep {
    std::size_t candidate = 0;
    MaybeEstimate gain;    ///< Less time than without it, s. Nothing without a pair of runs.
    MaybeEstimate so_far;  ///< Less time than with no signal equipped, s.
};

/// Why no further signal was chosen.
enum class EquipEnd : std::uint8_t {
    budget,     ///< As many as wanted are chosen.
    exhausted,  ///< All candidates are.
    no_effect,  ///< The interval of the next one's gain includes 0, or lies below it.
};

struct EquipPlan {
    std::vector<EquipStep> steps;  ///< By rank.
    EquipEnd end = EquipEnd::budget;
    std::optional<EquipStep> next;  ///< With `no_effect`: the one that was not chosen.
    std::size_t measured = 0;       ///< Sets for which `measure` was asked.
};

/// Chooses signals one by one: each time the candidate with the greatest mean gain over those chosen before,
/// of equal ones the first, until the budget is spent, no candidate is left or the gain of the next one is
/// not shown to be above 0. `none` are the values with no signal equipped. Intervals are t intervals of
/// paired differences; they are not adjusted for the choice among candidates, so that the gain of the chosen
/// is somewhat too high. The greedy choice is within 1 - 1/e of the best set if gains are submodular
/// (Nemhauser, Wolsey and Fisher 1978), and then the lazy search (Minoux 1978) finds what the thorough one
/// finds. Gains of signals need not be: a green may pay only with the next one.
EquipPlan equip_greedily(const Values& none, const EquipConfig& config, const MeasureSets& measure);

}  // namespace clearway::analysis
