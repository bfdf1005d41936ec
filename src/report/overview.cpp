#include "report/overview.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/controls.hpp"
#include "report/locks.hpp"
#include "report/shared_sentences.hpp"

namespace clearway::report {
namespace {

/// Seconds without a sign: whole ones from 10 s on, else one decimal.
std::string seconds(double value, Script script) {
    return number(std::abs(value), {std::abs(value) < 9.95 ? 1 : 0, script}) + " s";
}

/// ` (24 %)`, or nothing.
std::string percent_words(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const std::optional<double> percent = percent_of_baseline(scenario, condition);
    return percent ? fmt::format(" ({} %)", number(std::abs(*percent), {0, script})) : std::string();
}

/// What a headline calls a condition: one in which something fails says so, if its title does not.
std::string headline_name(const ConditionFacts& condition) {
    const std::string& failure = condition.condition.failure;
    const std::string preset = failure.substr(0, failure.find(','));
    if (failure == "perfect" || condition.title.find(preset) != std::string::npos) return condition.title;
    return fmt::format("{} (with failure {})", condition.title, failure);
}

/// `, most of it in the 9 of 60 trips that pass a signal`, where these are few; empty for other conditions
/// than that of the map.
std::string few_trips_words(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    constexpr double few = 0.25;
    if (signal_trips_words(scenario, condition, Script::plain).empty()) return {};
    const auto sum_s = [](const LaterArrivals& changes) {
        const analysis::MaybeEstimate mean = analysis::estimate_mean(changes.means_s);
        return mean ? std::abs(mean->mean) * static_cast<double>(changes.trips) : 0.0;
    };
    const SignalTrips& trips = scenario.map->signal_trips;
    const std::uint64_t all = trips.passing.trips + trips.others.trips;
    const bool are_few =
        trips.passing.trips > 0 && static_cast<double>(trips.passing.trips) < few * static_cast<double>(all);
    if (!are_few || sum_s(trips.passing) <= sum_s(trips.others)) return {};
    return fmt::format(", most of it in the {} of {} that pass a signal", grouped(trips.passing.trips),
                       counted(all, "trip"));
}

std::string emergency_clause(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const std::string name = headline_name(condition);
    const std::string& noun = scenario.emergency_noun;
    if (condition.objections.on_emergency())
        return fmt::format("{} {}", name, analysis::emergency_objections(condition.objections));
    const MaybeEstimate& difference = condition.difference(primary);
    const double mean = mean_of(difference).value_or(0.0);
    const std::string share = percent_words(scenario, condition, script);
    switch (effect_of(condition, primary)) {
        case Effect::better:
            return fmt::format("{} saves {} {} a trip{}{}{}", name, noun, seconds(mean, script), share,
                               few_trips_words(scenario, condition),
                               doubt_clause(condition, primary, script));
        case Effect::worse:
            return fmt::format("{} costs {} {} a trip{}{}", name, noun, seconds(mean, script), share,
                               doubt_clause(condition, primary, script));
        case Effect::negligible:
            return fmt::format("{} makes no relevant difference to {} ({} a trip)", name, noun,
                               signed_seconds(mean, script));
        case Effect::none_shown:
            return fmt::format("No effect of {} on {} is shown ({} a trip)", name, noun,
                               signed_seconds(mean, script));
        case Effect::too_few:
            return fmt::format("No verdict on {} yet: {} of at least {} runs", name, difference->n,
                               analysis::fewest_for_interval);
        case Effect::ruled_out:
        case Effect::undecided:
            break;
    }
    if (condition.emergency.total() == 0 && condition.complete_runs > 0)
        return fmt::format("No verdict on {}: the demand has no emergency vehicle", name);
    return fmt::format("No verdict on {}: {}", name, difference ? "no interval" : "no complete pair of runs");
}

std::string others_clause(const ConditionFacts& condition, Script script) {
    const MaybeEstimate& difference = condition.difference(Measure::other_time_loss);
    const double mean = mean_of(difference).value_or(0.0);
    if (effect_of(condition, Measure::other_time_loss) == Effect::better && is_barely_shown(difference))
        return fmt::format("other drivers are hardly faster ({} each)", signed_seconds(mean, script));
    const std::string own = doubts_of(condition, Measure::other_time_loss, script);
    const std::string doubts = own == doubts_of(condition, primary, script) ? "" : doubt_clause(own);
    switch (effect_of(condition, Measure::other_time_loss)) {
        case Effect::better:
            return fmt::format("other drivers save {} each{}", seconds(mean, script), doubts);
        case Effect::worse:
            return fmt::format("other drivers lose {} each{}", seconds(mean, script), doubts);
        case Effect::negligible:
        case Effect::none_shown:
            return fmt::format("no effect on other drivers is shown ({} each)", signed_seconds(mean, script));
        case Effect::ruled_out:
            return analysis::other_objections(condition.objections);
        case Effect::too_few:
        case Effect::undecided:
            break;
    }
    return {};
}

std::string collisions_clause(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    if (condition.complete_runs == 0) return {};
    if (condition.count("collisions") == 0)
        return fmt::format("no collision in {}", counted(condition.complete_runs, "run"));
    const Effect effect = effect_of(condition, Measure::collisions);
    const bool shown = effect == Effect::worse || effect == Effect::better;
    // What the tile says of such counts would not fit here.
    if (!shown && baseline_collides_by_model(scenario, condition)) return {};
    const char* const more = effect == Effect::worse    ? "more collisions than the baseline"
                             : effect == Effect::better ? "fewer collisions than the baseline"
                             : scenario.baseline_of(condition) == nullptr
                                 ? "collisions"
                                 : "no difference in collisions is shown";
    return fmt::format("{} ({})", more, collision_counts(scenario, condition));
}

std::string missing_clause(const ConditionFacts& condition) {
    const std::uint64_t absent = condition.failed.size() + condition.missing_runs;
    if (absent == 0) return {};
    return fmt::format("{} of {} runs {}", absent, absent + condition.complete_runs,
                       condition.failed.empty()      ? "missing"
                       : condition.missing_runs == 0 ? "failed"
                                                     : "failed or missing");
}

/// Whether a headline may be about it: a control is told under another condition, and one in which something
/// fails under the one in which nothing does.
bool can_be_featured(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    if (!condition.is_compared() || !condition.control_of.empty()) return false;
    const ConditionFacts* const working = working_of(scenario, condition);
    return working == nullptr || !working->control_of.empty();
}

/// Of those that a headline may be about, the one with the largest shown gain, else as `featured_condition`
/// says.
const ConditionFacts* largest_gain(const StudyFacts& study, const ScenarioFacts& scenario) {
    const ConditionFacts* best = nullptr;
    std::tuple<bool, int, double> best_rank;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!can_be_featured(scenario, condition)) continue;
        const bool helps = effect_of(condition, primary) == Effect::better;
        const int grade = helps ? 0 : condition.objections.on_emergency() ? 2 : 1;
        const std::tuple rank(reference_of(study, scenario, condition) != nullptr, grade,
                              mean_of(condition.difference(primary)).value_or(1e30));
        if (best != nullptr && rank >= best_rank) continue;
        best = &condition;
        best_rank = rank;
    }
    return best;
}

/// How much a condition needs: the fewer, the simpler.
std::size_t parts_of(const ConditionFacts& facts) {
    const experiment::ConditionSpec& condition = facts.condition;
    std::size_t parts = condition.policies.size() + condition.settings.size();
    if (condition.failure != "perfect") ++parts;
    if (condition.predictor != "none") ++parts;
    if (condition.bluelight == traffic::BlueLight::on) ++parts;
    return parts;
}

/// Whether a headline may be about it in place of the leader: it helps and was made likewise.
bool may_replace(const StudyFacts& study, const ScenarioFacts& scenario, const ConditionFacts& leader,
                 const ConditionFacts& condition) {
    return can_be_featured(scenario, condition) && effect_of(condition, primary) == Effect::better &&
           (reference_of(study, scenario, condition) != nullptr) ==
               (reference_of(study, scenario, leader) != nullptr);
}

/// What the others lose more under a condition than under another.
MaybeEstimate cost_between(const ConditionFacts& condition, const ConditionFacts& other) {
    return paired_difference(condition, other, Measure::other_time_loss);
}

/// Whether its gain is not shown to be smaller than the leader's, and its cost is shown to be lower.
bool is_cheaper(const ConditionFacts& condition, const ConditionFacts& leader) {
    const Effect time = effect_of(paired_difference(condition, leader, primary), Better::lower,
                                  leader.least_relevant(primary));
    return (time == Effect::none_shown || time == Effect::negligible) &&
           condition.baseline == leader.baseline && !condition.objections.on_others() &&
           effect_of(cost_between(condition, leader), Better::lower) == Effect::better;
}

/// Of those that are cheaper than the leader the cheapest, then the simplest; the leader if none is.
const ConditionFacts* cheapest(const StudyFacts& study, const ScenarioFacts& scenario,
                               const ConditionFacts& leader) {
    const auto rank = [](const ConditionFacts& one) {
        return std::pair(mean_of(one.value(Measure::other_time_loss)).value_or(0.0), parts_of(one));
    };
    const ConditionFacts* best = &leader;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (may_replace(study, scenario, leader, condition) && is_cheaper(condition, leader) &&
            (best == &leader || rank(condition) < rank(*best)))
            best = &condition;
    }
    return best;
}

/// How the condition that is shown stands to the one with the largest mean gain.
std::string choice_words(const ScenarioFacts& scenario, const ConditionFacts& shown,
                         const ConditionFacts& leader, bool some_fail) {
    constexpr NumberStyle style{.decimals = 1, .script = Script::typeset, .sign = Sign::always};
    const std::string among = some_fail ? " of those in which nothing fails" : "";
    if (&shown == &leader)
        return fmt::format(
            "; this one has the largest mean gain{}, which usually overstates its true gain a little", among);
    if (!scenario.chosen.empty()) return fmt::format("; {} has the largest mean gain{}", leader.title, among);
    if (is_cheaper(shown, leader))
        return fmt::format(
            "; the gain of {} is as large (EV travel time against this one {} s), and it costs other drivers "
            "{} s more each",
            leader.title, estimate(paired_difference(leader, shown, primary), style),
            estimate(cost_between(leader, shown), style));
    return "; this one is the simplest of those whose mean gain is as large but for less than what counts as "
           "a difference";
}

}  // namespace

std::string objection_without_failure(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const ConditionFacts* const working = working_of(scenario, condition);
    if (working == nullptr || !working->objections.on_emergency()) return {};
    return fmt::format("While nothing fails, {} {}: no gain can be claimed", working->title,
                       analysis::emergency_objections(working->objections));
}

const ConditionFacts* featured_condition(const StudyFacts& study, const ScenarioFacts& scenario) {
    const std::size_t chosen = scenario.place_of(scenario.chosen);
    if (chosen < scenario.conditions.size() && scenario.conditions[chosen].is_compared())
        return &scenario.conditions[chosen];
    const ConditionFacts* leader = largest_gain(study, scenario);
    if (leader == nullptr || effect_of(*leader, primary) != Effect::better) return leader;
    leader = cheapest(study, scenario, *leader);
    const double enough_s = leader->difference(primary)->mean + leader->least_relevant_s;
    const ConditionFacts* simplest = leader;
    for (const ConditionFacts& condition : scenario.conditions) {
        const bool level = may_replace(study, scenario, *leader, condition) &&
                           condition.difference(primary)->mean <= enough_s &&
                           effect_of(cost_between(condition, *leader), Better::lower) != Effect::worse;
        if (level && parts_of(condition) < parts_of(*simplest)) simplest = &condition;
    }
    return simplest;
}

std::string scenario_headline(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    const std::string unmet = unmet_incident_sentence(scenario, condition);
    const std::string cut_off = cut_off_words(condition);
    const std::string working = objection_without_failure(scenario, condition);
    std::string words = emergency_clause(scenario, condition, script);
    words = joined(std::move(words), lost_beside_words(condition));
    words = joined(std::move(words), others_clause(condition, script));
    words = joined(std::move(words), collisions_clause(scenario, condition));
    words = joined(std::move(words), missing_clause(condition));
    if (condition.is_unchecked()) words = joined(std::move(words), "the simulator's safety checks were off");
    return (cut_off.empty() ? cut_off : cut_off + ". ") + (unmet.empty() ? unmet : unmet + " ") +
           (working.empty() ? working : working + ". ") + words + "." +
           (condition.name() == scenario.chosen ? " Shown by your choice." : "");
}

std::string worst_trips(const ScenarioFacts& scenario, const ConditionFacts& condition, Script script) {
    std::string words;
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    for (const ConditionFacts* const one : {&condition, baseline}) {
        if (one == nullptr || !one->worst_trip) continue;
        const WorstTrip& trip = *one->worst_trip;
        words = joined(std::move(words),
                       fmt::format("{}: {} in replication {}, {}{}", one->title, printable(trip.vehicle),
                                   trip.replication, seconds(trip.seconds, script),
                                   trip.end.empty() ? "" : ", did not arrive: " + trip.end));
    }
    return words.empty() ? words : "Longest trip, " + words + ".";
}

std::string locks_sentence(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    std::string words;
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    for (const ConditionFacts* const one : {&condition, baseline}) {
        const std::string locks = one == nullptr ? "" : lock_words(*one);
        if (!locks.empty()) words = joined(std::move(words), one->title + ": " + locks);
    }
    return words.empty() ? words
                         : "Vehicles locked each other. " + words +
                               ". Fewer locks: " + lock_remedy(scenario.blockers) + ".";
}

std::string among_conditions(const StudyFacts& study, const ScenarioFacts& scenario) {
    std::size_t compared = 0;
    std::size_t help = 0;
    std::size_t corrected = 0;
    std::size_t objected = 0;
    bool some_fail = false;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!is_counted(study, scenario, condition)) continue;
        ++compared;
        some_fail = some_fail || !can_be_featured(scenario, condition);
        const bool helps = effect_of(condition, primary) == Effect::better;
        const auto& comparison = condition.outcome(primary).comparison;
        help += helps ? 1 : 0;
        corrected +=
            helps && comparison && comparison->holm_p.value_or(1.0) < 1.0 - analysis::usual_level ? 1 : 0;
        objected += condition.objections.on_emergency() ? 1 : 0;
    }
    if (compared < 2) return {};
    std::string words = help == 0 ? fmt::format("None of {} conditions is shown to help", compared)
                                  : fmt::format("{} of {} conditions {} shown to help", help, compared,
                                                help == 1 ? "is" : "are");
    if (help > 0 && corrected < help)
        words += fmt::format(", {} with Holm's correction for so many comparisons",
                             corrected == 0 ? "none" : std::to_string(corrected));
    const ConditionFacts* const shown = featured_condition(study, scenario);
    const ConditionFacts* const leader = largest_gain(study, scenario);
    if (leader != nullptr && help > (shown == leader ? 1 : 0))
        words += choice_words(scenario, *shown, *leader, some_fail);
    if (objected > 0)
        words += fmt::format("; {} lost or hit emergency vehicles, or ran without safety checks", objected);
    return words + ".";
}

std::string incidents_sentence(const ScenarioFacts& scenario, Script script) {
    if (!scenario.roads || scenario.roads->incidents.empty()) return {};
    constexpr std::size_t most_named = 3;
    const std::vector<MapIncident>& all = scenario.roads->incidents;
    const NumberStyle style{0, script};
    std::vector<std::string> words;
    for (const MapIncident& one : std::span(all).first(std::min(all.size(), most_named))) {
        words.push_back(fmt::format(
            "{} from {} to {} s{}, {}", printable(scenario.place_name(one.edge)), number(one.from_s, style),
            number(one.to_s, style),
            one.spread_s > 0.0 ? fmt::format(", in each run up to {} s later", number(one.spread_s, style))
                               : "",
            one.known_after_s ? fmt::format("known {} s after", number(*one.known_after_s, style))
                              : "known when a vehicle sees it"));
    }
    if (all.size() > most_named) words.push_back(fmt::format("and {} more", all.size() - most_named));
    return fmt::format("Blocked: {}.", fmt::join(words, "; "));
}

}  // namespace clearway::report
