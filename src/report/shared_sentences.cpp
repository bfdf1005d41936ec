#include "report/shared_sentences.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.hpp"
#include "experiment/condition_words.hpp"
#include "report/safety.hpp"

namespace clearway::report {
namespace {

/// Those who are called to an incident stop before it.
bool blocks_the_way(const RoadMap& roads) {
    return std::ranges::any_of(roads.incidents, [&](const MapIncident& incident) {
        return incident.is_closed && !core::contains(roads.calls, incident.edge, &MapCall::edge);
    });
}

bool is_shown_alone(Effect effect, const analysis::Comparison& comparison) {
    return is_clear(effect) && comparison.holm_p && *comparison.holm_p > 1.0 - analysis::usual_level;
}

void add_once(const std::string& word, std::vector<std::string>& words) {
    if (!core::contains(words, word)) words.push_back(word);
}

}  // namespace

std::string signed_seconds(double value, Script script) {
    return number(value, {std::abs(value) < 9.95 ? 1 : 0, script, Sign::always}) + " s";
}

std::string joined(std::string words, const std::string& more) {
    if (more.empty()) return words;
    return words.empty() ? more : words + "; " + more;
}

bool is_barely_shown(const MaybeEstimate& difference) {
    constexpr double near = 0.1;  // of the mean
    const analysis::Interval* const interval = shown_interval(difference);
    return interval != nullptr &&
           std::min(std::abs(interval->low), std::abs(interval->high)) < near * std::abs(difference->mean);
}

bool is_held_up(const analysis::Comparison& comparison) {
    return 2 * comparison.held_up_pairs > comparison.complete_pairs;
}

MaybeEstimate paired_difference(const ConditionFacts& first, const ConditionFacts& second, Measure measure) {
    return analysis::estimate_paired(first.outcome(measure).values, second.outcome(measure).values,
                                     analysis::MetricKind::quantity);
}

bool is_shown_alone(const ConditionFacts& condition, Measure measure) {
    const auto& comparison = condition.outcome(measure).comparison;
    return comparison && is_shown_alone(effect_of(condition, measure), *comparison);
}

std::string doubts_of(Effect effect, const analysis::Comparison& comparison, Script script) {
    if (!is_clear(effect)) return {};
    std::vector<std::string> words;
    if (is_held_up(comparison))
        words.push_back(fmt::format("locks held up an EV or one vehicle in a hundred in {} of {}",
                                    comparison.held_up_pairs, counted(comparison.complete_pairs, "pair")));
    if (const std::uint64_t pairs = comparison.difference->n; pairs < fewest_to_trust)
        words.push_back(fmt::format("{} pairs are few", pairs));
    if (is_shown_alone(effect, comparison))
        words.push_back(fmt::format("p {} after Holm's correction", p_words(comparison.holm_p, script)));
    return fmt::format("{}", fmt::join(words, "; "));
}

std::string doubts_of(const ConditionFacts& condition, Measure measure, Script script) {
    const auto& comparison = condition.outcome(measure).comparison;
    return comparison ? doubts_of(effect_of(condition, measure), *comparison, script) : "";
}

std::string doubt_clause(const std::string& doubts) {
    return doubts.empty() ? "" : " (doubtful: " + doubts + ")";
}

std::string doubt_clause(const ConditionFacts& condition, Measure measure, Script script) {
    return doubt_clause(doubts_of(condition, measure, script));
}

std::string kept_requests_sentence(const ScenarioFacts& scenario) {
    std::vector<std::string> failures;
    for (const ConditionFacts& one : scenario.conditions) {
        if (experiment::loses_no_request(one.condition)) add_once(one.condition.failure, failures);
    }
    return failures.empty() ? ""
                            : fmt::format(
                                  "No request of an EV to vehicles or signals is lost under {} (Q50 "
                                  "loses half).",
                                  fmt::join(failures, "; "));
}

bool is_judged_by_messages(const ConditionFacts& condition) {
    return experiment::unsent_words(condition.condition).empty();
}

std::string unsent_messages_sentence(const ScenarioFacts& scenario) {
    std::vector<std::string> sentences;
    for (const ConditionFacts& one : scenario.conditions)
        if (!is_judged_by_messages(one))
            add_once(fmt::format("{}: {}.", one.condition.failure, experiment::unsent_words(one.condition)),
                     sentences);
    return fmt::format("{}", fmt::join(sentences, " "));
}

std::string survivors_words(const ConditionFacts& condition, Script script) {
    const auto& of_all = condition.outcome(primary).comparison;
    const auto& of_arrived = condition.outcome(Measure::emergency_travel_time).comparison;
    if (!of_all || !of_arrived || !of_arrived->difference) return {};
    const analysis::Objections& counts = condition.objections;
    if (counts.emergency.lost() + counts.baseline_emergency.lost() == 0) return {};
    const NumberStyle style{.decimals = 1, .script = script, .sign = Sign::always};
    const std::string all_but =
        of_arrived->incomplete_pairs > 0 ? "" : fmt::format(", all but {}", of_arrived->vehicles_left_out);
    const MaybeEstimate& theirs = of_arrived->difference;
    const analysis::Interval* const interval = shown_interval(theirs);
    std::string words =
        fmt::format("EVs that arrived in both: {} s{}{}", number(theirs->mean, style),
                    interval == nullptr ? "" : " " + interval_text(*interval, style), all_but);
    if (of_all->median) words += fmt::format("; median of the pairs {} s", number(*of_all->median, style));
    return words;
}

std::string lost_beside_words(const ConditionFacts& condition) {
    return condition.objections.loses_emergency() ? "" : analysis::lost_words(condition.objections);
}

std::string collision_counts(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    std::string words = fmt::format("{} in {}", grouped(condition.count("collisions")),
                                    counted(condition.complete_runs, "run"));
    if (const ConditionFacts* const baseline = scenario.baseline_of(condition))
        words += fmt::format("; baseline {} in {}", grouped(baseline->count("collisions")),
                             baseline->complete_runs);
    return words;
}

/// Coarser ones make contacts of their own: docs/guides/your-study.md.
constexpr double step_for_safety_s = 0.1;

bool baseline_collides_by_model(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    return baseline != nullptr &&
           collide_by_model(baseline->count("collisions"), baseline->count("vehicle_count"));
}

std::string collision_notes(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    const std::uint64_t hit = condition.count("emergency_collisions");
    const std::uint64_t hit_before = baseline == nullptr ? 0 : baseline->count("emergency_collisions");
    std::vector<std::string> notes;
    if (hit + hit_before > 0)
        notes.push_back(fmt::format("{} with an EV{}", grouped(hit),
                                    baseline == nullptr ? "" : ", baseline " + grouped(hit_before)));
    if (baseline_collides_by_model(scenario, condition))
        notes.emplace_back("so many in the baseline that they say nothing about safety");
    else if (baseline != nullptr && baseline->count("collisions") > 0 &&
             scenario.step_length_s > step_for_safety_s + core::clock_tolerance_s)
        notes.push_back(
            fmt::format("at steps of {:g} s they compare conditions; a claim about safety needs "
                        "--step-length {:g}",
                        scenario.step_length_s, step_for_safety_s));
    return fmt::format("{}", fmt::join(notes, "; "));
}

std::string trip_changes_words(const ConditionFacts& condition, Script script) {
    const TripChanges& changes = condition.trip_changes;
    if (changes.trips == 0) return {};
    const NumberStyle whole{0, script};
    return fmt::format(
        "{} of {} over {:g} s faster{}, {} over {:g} s slower", grouped(changes.faster),
        counted(changes.trips, "trip"), felt_s,
        changes.faster == 0 ? "" : fmt::format(" ({} s in the mean)", number(changes.mean_faster_s, whole)),
        grouped(changes.slower), felt_s);
}

std::string signal_trips_words(const ScenarioFacts& scenario, const ConditionFacts& condition,
                               Script script) {
    if (scenario.of_map() != &condition || !scenario.roads || scenario.roads->signals.empty()) return {};
    const SignalTrips& trips = scenario.map->signal_trips;
    if (trips.others.trips == 0) return {};
    const NumberStyle style{1, script, Sign::always};
    const auto mean = [&](const LaterArrivals& changes) {
        return estimate(analysis::estimate_mean(changes.means_s), style);
    };
    const std::uint64_t all = trips.passing.trips + trips.others.trips;
    if (trips.passing.trips == 0) return fmt::format("none of {} passes a signal", counted(all, "trip"));
    return fmt::format("{} of {} pass a signal and change by {} s (mean of {} with such), the others by {} s",
                       grouped(trips.passing.trips), counted(all, "trip"), mean(trips.passing),
                       counted(trips.passing.means_s.size(), "pair"), mean(trips.others));
}

std::string cross_street_words(const ConditionFacts& condition, Script script) {
    const auto& comparison = condition.metric("cross_street_delay_s").comparison;
    if (!comparison || !comparison->difference) return {};
    const analysis::Interval* const interval = shown_interval(comparison->difference);
    if (interval == nullptr || interval->contains(0.0)) return {};
    const NumberStyle whole{.decimals = 0, .script = script, .sign = Sign::always};
    return fmt::format("on cross streets {} vehicle-s {} a passage of an EV",
                       number(comparison->difference->mean, whole), interval_text(*interval, {0, script}));
}

std::string privilege_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition,
                               Script script) {
    const std::vector<std::string> alone = {"red_privilege"};
    const auto passing = std::ranges::find_if(scenario.conditions, [&](const ConditionFacts& other) {
        return other.condition.policies == alone && other.condition.failure == condition.condition.failure;
    });
    if (passing == scenario.conditions.end() || &*passing == &condition || !condition.is_compared())
        return {};
    const MaybeEstimate difference = paired_difference(condition, *passing, primary);
    if (!difference) return {};
    return fmt::format("Against EVs that pass red ({}), s: {}.", passing->title,
                       estimate(difference, {1, script, Sign::always}));
}

std::string unmet_incident_words(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    if (baseline == nullptr || baseline->emergency.total() == 0 || !scenario.roads ||
        !blocks_the_way(*scenario.roads))
        return {};
    const analysis::Values& met = baseline->metric("emergency_met_incident").values;
    const bool is_counted = std::ranges::any_of(met, [](const auto& value) { return value.has_value(); });
    if (!is_counted || baseline->count("emergency_met_incident") > 0 ||
        condition.count("emergency_met_incident") > 0)
        return {};
    return fmt::format("0 of {} in the baseline", grouped(baseline->emergency.total()));
}

std::string unmet_incident_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const std::string words = unmet_incident_words(scenario, condition);
    if (words.empty()) return {};
    return fmt::format("No EV met the block ({}): these runs say nothing about it.", words);
}

std::string cut_off_words(const ConditionFacts& condition) {
    const double cut_off = condition.total("emergency_cut_off");
    if (cut_off == 0.0) return {};
    return counted(static_cast<std::uint64_t>(cut_off), "EV") + " cut off by an incident";
}

std::optional<double> percent_of_baseline(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const MaybeEstimate& difference = condition.difference(primary);
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    if (!difference || baseline == nullptr) return std::nullopt;
    const MaybeEstimate& base = baseline->value(primary);
    if (!base || base->mean == 0.0) return std::nullopt;
    return 100.0 * difference->mean / base->mean;
}

}  // namespace clearway::report
