#include "report/verdict.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiment/condition_words.hpp"
#include "experiment/settings.hpp"
#include "report/controls.hpp"
#include "report/lease_words.hpp"
#include "report/locks.hpp"
#include "report/shared_sentences.hpp"
#include "traffic/step_length.hpp"

namespace clearway::report {
namespace {

/// `-12.3 s [-15.0, -9.6]`.
std::string difference_text(const ScenarioFacts& scenario, const ConditionFacts& condition, Measure measure,
                            Script script) {
    const NumberStyle style{decimals_of(scenario, measure), script, Sign::always};
    const MaybeEstimate& difference = condition.difference(measure);
    if (!difference) return missing(script);
    std::string text = fmt::format("{} {}", number(difference->mean, style), info(measure).unit);
    if (const analysis::Interval* const interval = shown_interval(difference))
        text += " " + interval_text(*interval, style);
    return text;
}

/// Why a condition may have no effect; empty if nothing is known.
const char* reason_for_none(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const bool has_no_signals = scenario.roads && scenario.roads->signals.empty();
    return has_no_signals &&
                   !experiment::policies_with(condition.condition, traffic::Trait::asks_signals).empty()
               ? "; the network has no signals, so signal policies have no effect"
               : "";
}

Verdict lead(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const MaybeEstimate& difference = condition.difference(primary);
    std::string amount = "EV travel time " + difference_text(scenario, condition, primary, script);
    if (const auto percent = percent_of_baseline(scenario, condition))
        amount += fmt::format(", {} %", number(*percent, {0, script, Sign::always}));
    const double least = condition.least_relevant(primary);
    const Effect effect = effect_of(difference, Better::lower, least);
    if (condition.objections.loses_emergency())
        amount +=
            fmt::format(", one that did not arrive counting {} s", number(scenario.horizon_s, {0, script}));
    if (condition.objections.on_emergency())
        return {analysis::emergency_objections(condition.objections) +
                    (effect == Effect::worse ? " and harmed" : ""),
                difference ? amount : "no complete pair of runs to compare"};
    switch (effect) {
        case Effect::better:
            return {"helped", amount + doubt_clause(condition, primary, script)};
        case Effect::worse:
            return {"harmed", amount + doubt_clause(condition, primary, script)};
        case Effect::negligible:
            return {"no relevant effect",
                    fmt::format("{}, where {} s would count{}", amount, number(least, {1, script}),
                                reason_for_none(scenario, condition))};
        case Effect::none_shown:
            return {"no effect shown", amount + reason_for_none(scenario, condition)};
        case Effect::too_few:
            return {"no verdict", fmt::format("too few seeds, {} of at least {} ({})", difference->n,
                                              analysis::fewest_for_interval, amount)};
        case Effect::ruled_out:
        case Effect::undecided:
            break;
    }
    if (condition.emergency.total() == 0 && condition.complete_runs > 0)
        return {"no verdict", "the demand has no emergency vehicle"};
    return {"no verdict", difference ? fmt::format("no interval ({})", amount) : "no complete pair of runs"};
}

std::string sentence(std::string words) {
    if (!words.empty()) words.front() = static_cast<char>(std::toupper(words.front()));
    return words + ".";
}

/// `Collisions: 5 in 8 runs; baseline 0 in 8; 1 with an EV.`, where there are more and the difference is not
/// certain; empty otherwise.
std::string collisions_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    const Effect effect = effect_of(condition, Measure::collisions);
    const std::uint64_t count = condition.count("collisions");
    if (baseline == nullptr || is_clear(effect) ||
        count * baseline->complete_runs <= baseline->count("collisions") * condition.complete_runs)
        return {};
    const std::string notes = collision_notes(scenario, condition);
    return fmt::format("Collisions: {}{}.", collision_counts(scenario, condition),
                       notes.empty() ? "" : "; " + notes);
}

/// Certain changes of other measures; for the others' time loss also that no effect is shown.
std::vector<std::string> costs(const ScenarioFacts& scenario, const ConditionFacts& condition,
                               Script script) {
    std::vector<std::string> facts;
    const auto add = [&](Measure measure, const char* better, const char* worse, const char* none) {
        const Effect effect = effect_of(condition, measure);
        if (effect == Effect::undecided || effect == Effect::too_few || effect == Effect::ruled_out) return;
        const char* const words = effect == Effect::better ? better : effect == Effect::worse ? worse : none;
        if (*words == '\0') return;
        facts.push_back(
            sentence(fmt::format("{} ({}){}", words, difference_text(scenario, condition, measure, script),
                                 doubt_clause(condition, measure, script))));
    };
    add(Measure::other_time_loss, "the others lose less time", "the others lose more time",
        "no effect shown on the others' time loss");
    add(Measure::collisions, "fewer collisions", "more collisions", "");
    if (std::string more = collisions_of(scenario, condition); !more.empty())
        facts.push_back(std::move(more));
    add(Measure::teleports, "fewer teleports", condition.objections.teleported ? "" : "more teleports", "");
    add(Measure::unfinished, "fewer unfinished vehicles", "more unfinished vehicles", "");
    return facts;
}

}  // namespace

Effect effect_of(const MaybeEstimate& difference, Better better, double least_relevant) {
    if (!difference) return Effect::undecided;
    if (difference->n < analysis::fewest_for_interval) return Effect::too_few;
    const analysis::Interval* const interval = shown_interval(difference);
    if (interval == nullptr) return Effect::undecided;
    const bool excludes_zero = !interval->contains(0.0);
    const bool within = -least_relevant < interval->low && interval->high < least_relevant;
    if (within || (excludes_zero && std::abs(difference->mean) < least_relevant)) return Effect::negligible;
    if (!excludes_zero) return Effect::none_shown;
    return (interval->high < 0.0) == (better == Better::lower) ? Effect::better : Effect::worse;
}

Effect effect_of(const ConditionFacts& condition, Measure measure) {
    const Effect effect =
        effect_of(condition.difference(measure), info(measure).better, condition.least_relevant(measure));
    // The gap closed has no difference, and what rules a gain out rules it out, too.
    const bool undecided = effect == Effect::undecided && measure != Measure::gap_closed;
    if (effect == Effect::worse || undecided) return effect;
    const bool of_emergency = info(measure).relevance == Relevance::least || measure == Measure::gap_closed;
    const bool of_others = measure == Measure::waiting_time || measure == Measure::other_time_loss ||
                           measure == Measure::depart_delay;
    const analysis::Objections& objections = condition.objections;
    const bool ruled_out = objections.unchecked || (of_emergency && objections.on_emergency()) ||
                           (of_others && objections.on_others());
    return ruled_out ? Effect::ruled_out : effect;
}

bool is_void_for_lost(const ConditionFacts& condition, Measure measure) {
    return measure == Measure::gap_closed && condition.objections.loses_emergency() &&
           !condition.value(measure);
}

namespace {

/// `Locks: none (baseline: 2 locks in 1 of 20 runs). Fewer locks: ...`, or empty where there are none.
std::string locks_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    const std::string with = lock_words(condition);
    const std::string without = baseline == nullptr ? "" : lock_words(*baseline);
    if (condition.complete_runs == 0 || (with.empty() && without.empty())) return {};
    return fmt::format("Locks: {} (baseline: {}). Fewer locks: {}.", with.empty() ? "none" : with,
                       without.empty() ? "none" : without, lock_remedy(scenario.blockers));
}

/// `EV travel time where runs locked, s: ...`, what locked pairs make of the effect, or empty without any.
std::string locked_pairs_of(const ConditionFacts& condition, Script script) {
    const auto& comparison = condition.outcome(primary).comparison;
    if (!comparison) return {};
    const double wanted_s =
        condition.least_relevant_s > 0.0 ? condition.least_relevant_s : usual_least_relevant_s;
    const std::string pairs = locked_pairs_words(*comparison, wanted_s, script);
    return pairs.empty() ? pairs : fmt::format("EV travel time where runs locked, s: {}.", pairs);
}

/// `3 EVs came to a closed road (baseline: 12, whose trips change by -9.0 [-12.0, -6.0] s).`, or empty where
/// none did in either.
std::string incidents_of(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    const std::uint64_t met = condition.count("emergency_met_incident");
    const std::uint64_t met_before = baseline == nullptr ? 0 : baseline->count("emergency_met_incident");
    if (met + met_before == 0) return {};
    const MaybeEstimate& difference = condition.met_incident.difference_s;
    const std::string theirs = difference ? fmt::format(", whose trips change by {} s",
                                                        estimate(difference, {1, script, Sign::always}))
                                          : "";
    return fmt::format("{} came to a closed road (baseline: {}{}).", counted(met, "EV"), met_before, theirs);
}

/// What trials of other units, ways and holds found, or empty without them.
std::string regrets_of(const ConditionFacts& condition, Script script) {
    std::vector<std::string> facts;
    const MaybeEstimate& wrong = condition.metric("wrong_unit_share").estimate;
    const MaybeEstimate& unit_s = condition.metric("unit_regret_s").estimate;
    if (wrong && unit_s)
        facts.push_back(fmt::format("The wrong unit in {} % of decisions, {} s lost each.",
                                    number(100.0 * wrong->mean, {0, script}), estimate(unit_s, {1, script})));
    const MaybeEstimate& way_s = condition.metric("way_regret_s").estimate;
    if (way_s)
        facts.push_back(
            fmt::format("Against the best way, {} s lost on each.", estimate(way_s, {1, script})));
    const MaybeEstimate& hold_s = condition.metric("hold_regret_s").estimate;
    if (hold_s)
        facts.push_back(fmt::format("Against the best of other times of a hold, {} s lost at each signal.",
                                    estimate(hold_s, {1, script})));
    if (const std::uint64_t missing = condition.count("units_missing"); missing > 0)
        facts.push_back(fmt::format("{} missing.", counted(missing, "called unit")));
    return fmt::format("{}", fmt::join(facts, " "));
}

/// `no EV met the block (0 of 30 in the baseline), of which nothing is shown; `, or empty.
std::string unmet_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const std::string words = unmet_incident_words(scenario, condition);
    if (words.empty()) return {};
    return fmt::format("no EV met the block ({}), of which nothing is shown; ", words);
}

}  // namespace

Verdict verdict(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const std::size_t all = condition.failed.size() + condition.complete_runs + condition.missing_runs;
    std::string absent;
    if (!condition.failed.empty())
        absent = fmt::format("{} of {} failed; ", condition.failed.size(), counted(all, "run"));
    if (condition.missing_runs > 0)
        absent += fmt::format("{} of {} are missing; ", condition.missing_runs, counted(all, "run"));
    Verdict words = lead(scenario, condition, script);
    const std::string cut_off = cut_off_words(condition);
    words.finding =
        (cut_off.empty() ? "" : cut_off + "; ") + absent + unmet_of(scenario, condition) + words.finding;
    const analysis::Objections& counts = condition.objections;
    const std::string lost = lost_beside_words(condition);
    if (const std::string ends = joined(lost, survivors_words(condition, script)); !ends.empty())
        words.facts.push_back(sentence(fmt::format("{}; one that did not arrive counts with {} s", ends,
                                                   number(scenario.horizon_s, {0, script}))));
    if (counts.emergency.teleported + counts.baseline_emergency.teleported > 0)
        words.facts.push_back(
            "SUMO teleports an EV that has stood for time.time_to_teleport_s, as in a queue.");
    if (std::string trips = trip_changes_words(condition, script); !trips.empty())
        words.facts.push_back(trips + ".");
    if (std::string trips = signal_trips_words(scenario, condition, script); !trips.empty())
        words.facts.push_back(sentence(trips));
    const std::string others = analysis::other_objections(condition.objections);
    if (!others.empty()) words.facts.push_back(sentence(others));
    if (shown_interval(condition.difference(primary)) != nullptr)
        std::ranges::move(costs(scenario, condition, script), std::back_inserter(words.facts));
    if (const std::string cross = cross_street_words(condition, script); !cross.empty())
        words.facts.push_back(sentence("Lost " + cross));
    for (std::string fact :
         {failing_sentence(scenario, condition, script), privilege_sentence(scenario, condition, script),
          refusals_sentence(condition), controls_sentence(scenario, condition, script),
          incidents_of(scenario, condition, script), regrets_of(condition, script),
          locked_pairs_of(condition, script), locks_of(scenario, condition), idle_sentence(condition),
          own_lane_sentence(condition)})
        if (!fact.empty()) words.facts.push_back(std::move(fact));
    if (const std::size_t same = scenario.place_of(condition.same_as); same < scenario.conditions.size())
        words.facts.push_back(
            fmt::format("Every run is identical to that of {}.", scenario.conditions[same].label()));
    if (const std::string unsent = experiment::unsent_words(condition.condition); !unsent.empty())
        words.facts.push_back(unsent + ".");
    if (condition.is_unchecked())
        words.facts.push_back(
            "Safety checks of the simulator were off: vehicles may drive through each other.");
    return words;
}

std::string Verdict::text() const {
    std::string text = answer();
    for (const std::string& fact : facts)
        text += " " + fact;
    return text;
}

namespace {

/// Index in `verdict_words` of what the headline says about a condition.
std::size_t finding_of(const ConditionFacts& condition) {
    const analysis::Objections& objections = condition.objections;
    if (objections.loses_emergency()) return 0;
    if (objections.collisions) return 1;
    if (objections.unchecked) return 2;
    return 3 + static_cast<std::size_t>(effect_of(condition, primary));
}
constexpr std::array<const char*, 10> verdict_words = {"emergency vehicles lost",
                                                       "more collisions with emergency vehicles",
                                                       "safety checks off",
                                                       "emergency vehicles faster",
                                                       "slower",
                                                       "no relevant effect",
                                                       "no effect shown",
                                                       "",
                                                       "too few seeds",
                                                       "no verdict"};

}  // namespace

std::string coarse_step_sentence(double step_length_s) {
    if (step_length_s <= traffic::coarsest_trusted_step_s) return "";
    return fmt::format(
        "steps of {:g} s: use them only to compare with figures made with such steps. Vehicles react late, "
        "pass signals differently than at {:g} s, and some collide.",
        step_length_s, traffic::coarsest_trusted_step_s);
}

std::string uneven_runs_sentence(const ScenarioFacts& scenario) {
    constexpr std::size_t most_named = 3;
    std::vector<std::string> uneven;
    for (const ConditionFacts& condition : scenario.conditions) {
        const ConditionFacts* const baseline = scenario.baseline_of(condition);
        if (baseline == nullptr || baseline->complete_runs == condition.complete_runs) continue;
        const MaybeEstimate& difference = condition.difference(primary);
        uneven.push_back(fmt::format("{} {}, {} {}, {}", baseline->label(), baseline->complete_runs,
                                     condition.label(), condition.complete_runs,
                                     counted(difference ? difference->n : 0, "pair")));
    }
    if (uneven.empty()) return "";
    const std::size_t unnamed = uneven.size() - std::min(uneven.size(), most_named);
    uneven.resize(uneven.size() - unnamed);
    if (unnamed > 0) uneven.push_back(fmt::format("and {} more", unnamed));
    return fmt::format(
        "Means are over the runs that there are, differences over pairs of runs with the same seed alone, so "
        "they need not agree: {}.",
        fmt::join(uneven, "; "));
}

std::string few_seeds_sentence(std::uint64_t fewest) {
    if (fewest < analysis::fewest_for_interval)
        return fmt::format("too few seeds: fewer than {} give no interval and no effect; see --seeds.",
                           analysis::fewest_for_interval);
    if (fewest < fewest_to_trust)
        return fmt::format(
            "few seeds: means and intervals from fewer than {} seeds are unreliable; see --seeds.",
            fewest_to_trust);
    return "";
}

std::string few_seeds_sentence(const StudyFacts& study) {
    std::uint64_t fewest = fewest_to_trust;
    for (const ScenarioFacts& scenario : study.scenarios)
        fewest = std::min(fewest, scenario.replications);
    return few_seeds_sentence(fewest);
}

bool is_counted(const StudyFacts& study, const ScenarioFacts& scenario, const ConditionFacts& condition) {
    if (!condition.is_compared() || reference_of(study, scenario, condition) != nullptr) return false;
    if (condition.control_of.empty()) return true;
    const std::size_t of = scenario.place_of(condition.control_of);
    return of < scenario.conditions.size() && working_of(scenario, scenario.conditions[of]) == &condition;
}

const ConditionFacts* reference_of(const StudyFacts& study, const ScenarioFacts& scenario,
                                   const ConditionFacts& condition) {
    for (const Sensitivity& sensitivity : study.sensitivities) {
        if (!sensitivity.has_level(scenario.name, condition.name())) continue;
        const std::size_t place = scenario.place_of(sensitivity.condition);
        if (place < scenario.conditions.size()) return &scenario.conditions[place];
    }
    return nullptr;
}

bool stands_out(const ConditionFacts& condition, const ConditionFacts& reference) {
    const auto turned_worse = [&](Measure measure) {
        return effect_of(condition, measure) == Effect::worse &&
               effect_of(reference, measure) != Effect::worse;
    };
    return finding_of(condition) != finding_of(reference) || turned_worse(Measure::collisions) ||
           turned_worse(Measure::teleports) || turned_worse(Measure::unfinished) || !condition.failed.empty();
}

std::string headline(const StudyFacts& study) {
    std::string turned;
    for (const Sensitivity& sensitivity : study.sensitivities)
        turned += sensitivity_sentence(sensitivity) + ". ";
    std::vector<std::string> parts;
    for (const ScenarioFacts& scenario : study.scenarios) {
        std::size_t compared = 0;
        std::array<std::size_t, verdict_words.size()> seen = {}, alone = {};
        for (const ConditionFacts& condition : scenario.conditions) {
            if (!is_counted(study, scenario, condition)) continue;
            ++compared;
            ++seen[finding_of(condition)];
            alone[finding_of(condition)] += is_shown_alone(condition, primary) ? 1 : 0;
        }
        if (compared == 0) continue;
        std::vector<std::string> findings;
        for (std::size_t finding = 0; finding < seen.size(); ++finding) {
            if (seen[finding] == 0) continue;
            const std::string total =
                findings.empty() ? fmt::format(" of {}", counted(compared, "condition")) : "";
            const std::string corrected =
                alone[finding] == 0 ? ""
                                    : fmt::format(" ({} with Holm's correction)",
                                                  alone[finding] == seen[finding]
                                                      ? "none"
                                                      : std::to_string(seen[finding] - alone[finding]));
            findings.push_back(
                fmt::format("{} under {}{}{}", verdict_words[finding], seen[finding], total, corrected));
        }
        parts.push_back(fmt::format("{}: {}", scenario.name, fmt::join(findings, ", ")));
    }
    if (!parts.empty()) return fmt::format("{}{}.", turned, fmt::join(parts, "; "));
    if (turned.empty()) return "No condition was compared with a baseline.";
    turned.pop_back();
    return turned;
}

}  // namespace clearway::report
