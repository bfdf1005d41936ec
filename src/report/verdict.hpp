#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/spellings.hpp"
#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// What a paired difference shows. It follows only from the 95 % interval and the least relevant difference.
enum class Effect : std::uint8_t {
    better,
    worse,
    negligible,  ///< The mean, or the whole interval, is smaller than the least relevant difference.
    none_shown,  ///< The interval includes 0.
    ruled_out,   ///< Of the above only `worse` may be claimed; see analysis::Objections.
    too_few,     ///< Fewer than `analysis::fewest_for_interval` complete pairs.
    undecided,   ///< No complete pair.
};
/// The words of JSON.
constexpr core::Spellings<Effect, 7> spellings(Effect) {
    return {{{Effect::better, "better"},
             {Effect::worse, "worse"},
             {Effect::negligible, "negligible"},
             {Effect::none_shown, "none_shown"},
             {Effect::ruled_out, "ruled_out"},
             {Effect::too_few, "too_few_seeds"},
             {Effect::undecided, "undecided"}}};
}

/// Whether an effect is claimed.
constexpr bool is_clear(Effect effect) {
    return effect == Effect::better || effect == Effect::worse;
}

/// A bound of exactly 0 counts as included. Objections are ignored.
Effect effect_of(const MaybeEstimate& difference, Better better, double least_relevant = 0.0);
/// The same, unless objections against the condition rule it out. All output uses this.
Effect effect_of(const ConditionFacts& condition, Measure measure);

/// Whether a measure has no value because the condition lost more EVs than its baseline.
bool is_void_for_lost(const ConditionFacts& condition, Measure measure);

/// What is said of a condition against the baseline. Plain text, not escaped.
struct Verdict {
    std::string finding;  ///< `helped`: objections on the side of EVs, or whether EVs were faster.
    std::string figures;  ///< By how much.
    /// A sentence each: what it cost the others, what weighs on the figure, what its policies did.
    std::vector<std::string> facts = {};

    /// The answer: `helped: EV travel time -12.3 s [-15.0, -9.6].`
    std::string answer() const { return finding + ": " + figures + "."; }
    /// All in one paragraph.
    std::string text() const;
};
Verdict verdict(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// Whether verdicts count it: compared with a baseline, at its defaults, and no control but the same as
/// another while nothing fails.
bool is_counted(const StudyFacts& study, const ScenarioFacts& scenario, const ConditionFacts& condition);

/// The condition at its defaults of which this one has a setting turned alone; null for other conditions.
const ConditionFacts* reference_of(const StudyFacts& study, const ScenarioFacts& scenario,
                                   const ConditionFacts& condition);

/// Whether a condition must be named beside the one from which it differs in a setting: another finding on
/// EVs, more collisions, teleports or unfinished vehicles, failed runs.
bool stands_out(const ConditionFacts& condition, const ConditionFacts& reference);

/// Marks results of steps above 0.25 s; empty for others.
std::string coarse_step_sentence(double step_length_s);

/// `Means are over ...`: why differences of a scenario's tables are not those of its means, where conditions
/// have fewer or more runs than their baseline; empty otherwise. Plain text.
std::string uneven_runs_sentence(const ScenarioFacts& scenario);

/// With fewer seeds a mean and its interval change much when seeds are added: with three, a condition closed
/// 56 % of the gap on a map that was imported, with twelve 17 %.
inline constexpr std::uint64_t fewest_to_trust = 10;
/// What to think of as few seeds, or pairs of runs; empty for enough.
std::string few_seeds_sentence(std::uint64_t fewest);
/// The same of a study's scenarios.
std::string few_seeds_sentence(const StudyFacts& study);

/// One or two sentences for the whole study: how many settings matter where they were turned one at a time,
/// and what EV travel time says of every other condition but the baselines. Plain text.
std::string headline(const StudyFacts& study);

}  // namespace clearway::report
