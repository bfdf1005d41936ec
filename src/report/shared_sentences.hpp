#pragma once

#include <optional>
#include <string>

#include "report/facts.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report {

// What a report's first screen (report/overview.hpp) and its verdicts (report/verdict.hpp) both say of a
// condition. Plain text.

/// `-5.2 s`, `+12 s`: whole seconds from 10 s on, else one decimal.
std::string signed_seconds(double value, Script script);
/// Both with a semicolon between them; the one if the other is empty.
std::string joined(std::string words, const std::string& more);

/// A measure under the first condition minus that under the second, in the same replications.
MaybeEstimate paired_difference(const ConditionFacts& first, const ConditionFacts& second, Measure measure);

/// Whether the interval ends so near 0 that the first digits of its ends would not tell them apart.
bool is_barely_shown(const MaybeEstimate& difference);

/// `5 pairs are few; p 0.072 after Holm's correction`: why chance or locks could be all of an effect that
/// its interval shows. Empty where nothing speaks for that.
std::string doubts_of(const ConditionFacts& condition, Measure measure, Script script);
/// Whether locks hold up a run in most pairs, so that these say little about a policy.
bool is_held_up(const analysis::Comparison& comparison);
/// Whether an effect is shown by its own interval, and not once p is corrected for all comparisons (Holm).
bool is_shown_alone(const ConditionFacts& condition, Measure measure);
/// The same of a comparison with that effect.
std::string doubts_of(Effect effect, const analysis::Comparison& comparison, Script script);
/// ` (doubtful: 5 pairs are few)`, or nothing.
std::string doubt_clause(const std::string& doubts);
std::string doubt_clause(const ConditionFacts& condition, Measure measure, Script script);

/// `No request of an EV to vehicles or signals is lost under B10 (Q50 loses half).` Empty where nothing else
/// fails.
std::string kept_requests_sentence(const ScenarioFacts& scenario);

/// Whether its policies send the messages that its failure loses, if it loses any.
bool is_judged_by_messages(const ConditionFacts& condition);
/// `Q50: check_in_out sends no messages, so those that this failure loses stand for nothing.` Empty where all
/// are judged by messages.
std::string unsent_messages_sentence(const ScenarioFacts& scenario);

/// `EVs that arrived in both: -10.3 s [-30.1, 9.5], all but 1; median of the pairs -4.7 s`: the travel time
/// without the horizon that stands for an EV that did not arrive. Empty where all arrived in both.
std::string survivors_words(const ConditionFacts& condition, Script script);

/// `8 of 60 trips over 5 s faster (71 s in the mean), 2 over 5 s slower`: where a mean comes from. Empty
/// without trips that arrived in both.
std::string trip_changes_words(const ConditionFacts& condition, Script script);

/// `9 of 30 trips pass signals: -60 s in the mean, the others +0.1 s`: what signals can gain at most. Empty
/// where all pass some, without signals, and for conditions that the maps are not about.
std::string signal_trips_words(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// `on cross streets +28 vehicle-s [11, 46] a passage of an EV`: what a mean over all drivers hides. Empty
/// where it is not shown.
std::string cross_street_words(const ConditionFacts& condition, Script script);

/// `Against EVs that pass red (red_privilege), s: -5.8 [-9.6, -2.0].` Empty where the study does not run
/// them, and of them.
std::string privilege_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script);

/// analysis::lost_words where they are no objection: the baseline lost as many. Plain text.
std::string lost_beside_words(const ConditionFacts& condition);

/// `5 in 8 runs; baseline 0 in 8`: collisions of a condition with a complete run.
std::string collision_counts(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// Whether the baseline collides so often that its model of drivers makes the collisions (collide_by_model).
bool baseline_collides_by_model(const ScenarioFacts& scenario, const ConditionFacts& condition);
/// `2 with an EV, baseline 0; so many in the baseline that they say nothing about safety`: what such counts
/// hide, and at coarse steps what a claim needs.
std::string collision_notes(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// `0 of 30 in the baseline`: EVs that met an incident which blocks their way; empty where one did.
std::string unmet_incident_words(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// `No EV met the block (0 of 30 in the baseline): these runs say nothing about it.` Empty where one did,
/// where no incident closes a road to EVs on their way, and without a complete run of the baseline. Plain
/// text.
std::string unmet_incident_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition);

/// `2 EVs cut off by an incident`, or empty. Plain text.
std::string cut_off_words(const ConditionFacts& condition);

/// Difference in the primary measure as a share of the baseline's, %.
std::optional<double> percent_of_baseline(const ScenarioFacts& scenario, const ConditionFacts& condition);

}  // namespace clearway::report
