#include "report/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "report/controls.hpp"
#include "report/overview.hpp"
#include "report/shared_sentences.hpp"

namespace clearway::report {
namespace {

/// `95 % interval -30 to -22 s`; empty without one.
std::string interval_words(const MaybeEstimate& difference, Script script) {
    const analysis::Interval* const interval = shown_interval(difference);
    if (interval == nullptr) return {};
    const double most = std::max(std::abs(interval->low), std::abs(interval->high));
    const NumberStyle style{most < 9.95 ? 1 : 0, script};
    const auto [low, high] = interval_ends(*interval, style);
    return fmt::format("95 % interval {} to {} s", low, high);
}

Tile::Tone tone_of(Effect effect) {
    return effect == Effect::better  ? Tile::Tone::better
           : effect == Effect::worse ? Tile::Tone::worse
                                     : Tile::Tone::neutral;
}

/// What an effect is called where the reader sees the measure beside it.
const char* words_of(Effect effect, const char* better, const char* worse) {
    switch (effect) {
        case Effect::better:
            return better;
        case Effect::worse:
            return worse;
        case Effect::negligible:
            return "mean below what counts";
        case Effect::none_shown:
            return "no effect shown";
        case Effect::ruled_out:
            return "no gain can be claimed";
        case Effect::too_few:
            return "too few runs for a verdict";
        case Effect::undecided:
            break;
    }
    return "no verdict";
}

/// How a tile describes its figure.
struct TileWords {
    const char* subject;
    const char* better;
    const char* worse;
};

Tile time_tile(const TileWords& words, const ConditionFacts& condition, Measure measure, Script script) {
    const MaybeEstimate& difference = condition.difference(measure);
    const Effect effect = effect_of(condition, measure);
    Tile tile{words.subject,
              difference ? signed_seconds(difference->mean, script) : missing(script),
              words_of(effect, words.better, words.worse),
              {},
              tone_of(effect)};
    tile.meaning = joined(std::move(tile.meaning), interval_words(difference, script));
    if (effect == Effect::better && is_barely_shown(difference)) tile.tone = Tile::Tone::neutral;
    if (const std::string doubts = doubts_of(condition, measure, script); !doubts.empty()) {
        tile.meaning += "; doubtful: " + doubts;
        tile.tone = Tile::Tone::neutral;
    }
    return tile;
}

/// ` If the difference is really the 5.2 s seen, about 24 pairs show it in four studies of five.`; empty
/// where these are less than what counts.
std::string what_shows_the_seen(const analysis::Estimate& difference, double counts_s, Script script) {
    const double seen_s = std::abs(difference.mean);
    if (seen_s <= (counts_s > 0.0 ? counts_s : usual_least_relevant_s)) return "";
    const std::size_t pairs =
        std::max(analysis::fewest_replications, analysis::replications_to_show(difference.deviation, seen_s));
    return fmt::format(
        " If the difference is really the {} s seen, {} pairs show it in four studies of five.",
        number(seen_s, {1, script}), asked_words(pairs));
}

/// `; about 24 pairs would (80 % power) if the difference is as seen`: so many show the effect that
/// is seen among all comparisons of the scenario, each at its share of the level (Bonferroni, which is no
/// less strict than Holm).
std::string what_shows_it_among_all(const ScenarioFacts& scenario, const analysis::Estimate& difference) {
    const auto is_tested = [](const ConditionFacts& condition) {
        const auto& comparison = condition.outcome(primary).comparison;
        return comparison && comparison->t_p.has_value();
    };
    const auto tests = static_cast<double>(std::ranges::count_if(scenario.conditions, is_tested));
    if (tests == 0.0 || difference.mean == 0.0) return "";
    const double level = 1.0 - (1.0 - analysis::usual_level) / tests;
    return fmt::format(
        "; {} pairs would (80 % power) if the difference is as seen",
        asked_words(analysis::replications_to_show(difference.deviation, std::abs(difference.mean), level)));
}

}  // namespace

Tile emergency_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    Tile tile = time_tile({"Emergency vehicles: travel time", "faster trips", "slower trips"}, condition,
                          primary, script);
    const std::optional<double> percent = percent_of_baseline(scenario, condition);
    if (percent) tile.figure += fmt::format(", {} %", number(*percent, {0, script, Sign::always}));
    const std::string survivors = survivors_words(condition, script);
    if (condition.objections.on_emergency()) {
        tile.tone = Tile::Tone::worse;
        tile.meaning = analysis::emergency_objections(condition.objections) + "; no gain can be claimed";
    }
    if (condition.objections.loses_emergency()) {
        tile.subject = "Emergency vehicles";
        // The mean says little more than the horizon that a lost EV counts with.
        const std::string mean = std::exchange(
            tile.figure, fmt::format("{} of {} lost", grouped(condition.objections.emergency.lost()),
                                     grouped(condition.objections.emergency.total())));
        tile.meaning = joined(std::move(tile.meaning), survivors);
        tile.meaning += fmt::format("; mean of all {}, where one that did not arrive counts with {} s", mean,
                                    number(scenario.horizon_s, {0, script}));
    } else {
        tile.meaning = joined(std::move(tile.meaning), survivors);
    }
    if (!objection_without_failure(scenario, condition).empty()) tile.tone = Tile::Tone::neutral;
    tile.details = {working_words(scenario, condition, script), trip_changes_words(condition, script),
                    signal_trips_words(scenario, condition, script)};
    std::erase(tile.details, "");
    return tile;
}

Tile incident_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const analysis::MetIncident& met = condition.met_incident;
    if (met.vehicles == 0)
        return {"Those that met the incident", "0", unmet_incident_sentence(scenario, condition)};
    const MaybeEstimate& difference = met.difference_s;
    const Effect effect = effect_of(difference, Better::lower, condition.least_relevant(primary));
    Tile tile{"Those that met the incident",
              difference ? signed_seconds(difference->mean, script) : missing(script),
              words_of(effect, "faster trips", "slower trips"),
              {},
              tone_of(effect)};
    tile.meaning = joined(std::move(tile.meaning), interval_words(difference, script));
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    tile.meaning += fmt::format("; they are {} of {} in {}", grouped(met.vehicles),
                                counted(condition.emergency.total(), "EV"),
                                baseline == nullptr ? condition.baseline : baseline->title);
    tile.meaning += fmt::format("; {} of them meet it with this condition", grouped(met.still));
    const bool navigates = core::contains(condition.condition.policies, "navigate");
    if (navigates && controls_note(scenario, condition, script).empty())
        tile.meaning += "; studies/accident.toml tells what hearing of it is worth to all";
    return tile;
}

Tile others_tile(const ScenarioFacts& /*scenario*/, const ConditionFacts& condition, Script script) {
    Tile tile = time_tile({"Other drivers: time loss", "lose less time each", "lose more time each"},
                          condition, Measure::other_time_loss, script);
    tile.meaning = joined(std::move(tile.meaning), cross_street_words(condition, script));
    if (condition.objections.on_others()) {
        const std::string objections = analysis::other_objections(condition.objections);
        if (!objections.empty()) tile.tone = Tile::Tone::worse;
        tile.meaning = joined(objections, tile.meaning);
    }
    return tile;
}

Tile safety_tile(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    Tile tile{"Safety", missing(script), "no complete run"};
    if (condition.complete_runs == 0) return tile;
    const std::uint64_t count = condition.count("collisions");
    tile.figure = count == 0 ? "no collision" : counted(count, "collision");
    tile.meaning = "in " + counted(condition.complete_runs, "run");
    if (const ConditionFacts* const baseline = scenario.baseline_of(condition))
        tile.meaning += fmt::format("; baseline: {} in {}", grouped(baseline->count("collisions")),
                                    baseline->complete_runs);
    const Effect effect = effect_of(condition, Measure::collisions);
    tile.tone = tone_of(effect);
    if (effect == Effect::better) tile.meaning += "; fewer";
    if (effect == Effect::worse) tile.meaning += "; more";
    tile.meaning = joined(std::move(tile.meaning), collision_notes(scenario, condition));
    if (condition.objections.collisions) tile.tone = Tile::Tone::worse;
    if (condition.is_unchecked()) {
        tile.tone = Tile::Tone::worse;
        tile.meaning += "; the simulator's safety checks were off";
    }
    return tile;
}

Badge badge_of(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const MaybeEstimate& difference = condition.difference(primary);
    const std::uint64_t count = difference ? difference->n : 0;
    const std::string pairs = counted(count, "pair") + " of runs";
    const bool is_trusted = count >= fewest_to_trust;
    const std::string few =
        is_trusted ? "" : fmt::format("; below {} means and intervals are unreliable", fewest_to_trust);
    const Badge::Runs runs = is_trusted ? Badge::Runs::enough : Badge::Runs::too_few;
    const char* const quantity = is_trusted ? "Enough" : "Few";
    // What the intervals alone show: objections are counts and need no interval.
    switch (effect_of(difference, Better::lower, condition.least_relevant(primary))) {
        case Effect::better:
        case Effect::worse:
            if (is_shown_alone(condition, primary))
                return {Badge::Runs::too_few,
                        fmt::format("Not enough runs: {} show the direction of one comparison alone, not "
                                    "after Holm's correction{}",
                                    pairs, what_shows_it_among_all(scenario, *difference))};
            if (is_held_up(*condition.outcome(primary).comparison))
                return {
                    Badge::Runs::too_few,
                    fmt::format("Doubtful: {} show the direction, but locks hold up traffic in {} of them",
                                pairs, condition.outcome(primary).comparison->held_up_pairs)};
            return {runs, fmt::format("{} runs: {} show the direction{}", quantity, pairs, few)};
        case Effect::negligible:
            return {runs, fmt::format("{} runs: {} show a mean difference below what counts{}", quantity,
                                      pairs, few)};
        case Effect::none_shown: {
            if (const std::string unmet = unmet_incident_sentence(scenario, condition); !unmet.empty())
                return {Badge::Runs::too_few,
                        unmet + " Block a road that EVs pass: clearway scenario check names some."};
            const std::uint64_t needed = condition.precision ? condition.precision->needed : 0;
            if (!survivors_words(condition, script).empty())
                return {Badge::Runs::too_few,
                        fmt::format("Not enough runs: {}; EVs that did not arrive decide their mean, so no "
                                    "number that would be enough is given",
                                    pairs)};
            const double counts_s = condition.least_relevant(primary);
            const std::string least = number(counts_s > 0.0 ? counts_s : usual_least_relevant_s, {1, script});
            if (needed <= count)
                return {Badge::Runs::enough,
                        fmt::format("Enough runs: {} tell the mean to within {} s", pairs, least)};
            return {
                Badge::Runs::too_few,
                fmt::format("Not enough runs: {}.{} To tell the mean to within {} s takes {}.", pairs,
                            what_shows_the_seen(*difference, counts_s, script), least, asked_words(needed))};
        }
        case Effect::too_few:
            return {Badge::Runs::too_few, fmt::format("Not enough runs: {}, at least {} for any verdict",
                                                      pairs, analysis::fewest_for_interval)};
        case Effect::ruled_out:
        case Effect::undecided:
            break;
    }
    return {Badge::Runs::too_few,
            scenario.replications == 0 ? "No runs" : "Not enough runs: no complete pair"};
}

}  // namespace clearway::report
