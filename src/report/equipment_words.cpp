// What `clearway equip` says in sentences, on the terminal and on its page.

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <ranges>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/process.hpp"
#include "core/terminal.hpp"
#include "report/detail/equipment_order.hpp"
#include "report/detail/equipment_sheets.hpp"
#include "report/equipment.hpp"
#include "report/locks.hpp"
#include "report/safety.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::EquipEnd;
using detail::great_share;
using detail::has_order;
using detail::is_chance;
using detail::is_exactly_none;
using detail::is_shown_of;
using detail::most_are_held_up;
using detail::numbered_name;
using detail::others_cell;
using detail::others_save;
using detail::pair_of;
using detail::pairs_to_tell;
using detail::seeds_to_show;
using detail::small_map_of;
using detail::tells_passing;
using detail::tells_sum;

const char* shown_word(const analysis::MaybeEstimate& value) {
    return is_shown(value) ? "shown" : "not shown";
}

std::string estimate_or_dash(const analysis::MaybeEstimate& value) {
    return estimate(value, {});
}

/// `the others lose 1.0 [0.6, 1.4] s each (shown)`
std::string others_words(const EquipmentFacts& facts) {
    const analysis::MaybeEstimate others = others_cell(facts, facts.ranked.back().others);
    return fmt::format("the others {} {} s each ({})", others_save(facts) ? "save" : "lose",
                       estimate_or_dash(others), shown_word(others));
}

/// `#4, #1`
template <class Numbers>
std::string hashed(const Numbers& numbers, const char* between = ", ") {
    return fmt::format("#{}", fmt::join(numbers, fmt::format("{}#", between)));
}

/// Numbers of the signals of the first ranks.
std::vector<std::size_t> first_numbers(const EquipmentFacts& facts, std::size_t ranks) {
    std::vector<std::size_t> numbers;
    for (const EquippedSignal& signal : std::span(facts.ranked).first(std::min(ranks, facts.ranked.size())))
        numbers.push_back(signal.number);
    return numbers;
}

std::string together_sentence(const EquipmentFacts& facts) {
    std::vector<std::string> words;
    for (const EquipPairFacts& pair : facts.pairs) {
        if (!pair.chosen) continue;
        const auto is_of = [&](const EquippedSignal& one) { return pair_of(facts, one) == &pair; };
        const auto first = std::ranges::find_if(facts.ranked, is_of) - facts.ranked.begin();
        const std::string gain = estimate_or_dash(pair.both_gain);
        words.push_back(fmt::format(
            "{}, which {} ({})", hashed(pair.numbers, " and "),
            first == 0 ? fmt::format("bring {} s", gain)
                       : fmt::format("add {} s to {}", gain,
                                     hashed(first_numbers(facts, static_cast<std::size_t>(first)))),
            shown_word(pair.both_gain)));
    }
    return words.empty() ? "" : fmt::format("Chosen as a pair: {}.", fmt::join(words, "; "));
}

std::string seeds_sentence(const EquipmentFacts& facts) {
    const analysis::MaybeEstimate& gain = facts.ranked.back().so_far;
    if (analysis::shown_interval(gain) == nullptr || is_shown(gain)) return "";
    if (gain->mean <= 0.0) return "Their mean is no gain.";
    if (!has_order(facts) && !small_map_of(facts).empty()) return "";
    const std::size_t seeds = seeds_to_show(facts);
    if (seeds > analysis::most_equip_replications)
        return fmt::format("It would take more than {} seeds to show so small a gain of all.",
                           analysis::most_equip_replications);
    return fmt::format("About {} seeds would likely (80 %) show the gain of all, if it is as it looks.",
                       seeds);
}

/// `On the fresh seeds vehicles locked each other in 4 of 30 runs, ...`, or empty.
std::string unsound_sentence(const EquipmentFacts& facts) {
    if (facts.unsound.words().empty()) return "";
    const std::string text = "On the fresh seeds " + facts.unsound.words();
    if (!facts.unsound.say_little()) return text + ".";
    return fmt::format("{}: such runs say little of signals. Less traffic: --density {}, or less.", text,
                       less_density(facts.density));
}

/// `Of 60 fresh trips 45 (75 %) pass a chosen signal and gain 12.3 [8.1, 16.5] s each (shown); the others
/// ...`
std::string split_sentence(const EquipmentFacts& facts) {
    const analysis::GainSplit& split = facts.split;
    if (split.trips == 0) return "";
    if (split.passing == 0) return "No fresh trip passes a chosen signal.";
    const auto gain = [](const analysis::MaybeEstimate& value) {
        return fmt::format("gain {} s each ({})", estimate_or_dash(value), shown_word(value));
    };
    if (tells_passing(facts)) return fmt::format("The other trips {}.", gain(split.other_gain));
    const std::string others =
        split.passing == split.trips ? "" : fmt::format("; the other trips {}", gain(split.other_gain));
    return fmt::format(
        "Of {} on the fresh seeds, which only measure, {} ({:.0f} %) pass a chosen signal and {}{}.",
        counted(split.trips, "trip"), split.passing,
        100.0 * static_cast<double>(split.passing) / static_cast<double>(split.trips),
        gain(split.passing_gain), others);
}

/// A rank that few trips pass rests on them alone.
std::string few_trips_sentence(const EquipmentFacts& facts) {
    constexpr double few = 10.0;
    std::map<std::size_t, std::string> words;  // by rank
    for (const EquipCandidateFacts& candidate : facts.candidates) {
        const double trips = candidate.trips * static_cast<double>(facts.met.trips);
        if (candidate.rank && trips < few)
            words[*candidate.rank] = fmt::format("#{}: {:.0f}", candidate.number, trips);
    }
    if (words.empty()) return "";
    std::vector<std::string> by_rank;
    for (const auto& [rank, text] : words)
        by_rank.push_back(text);
    return fmt::format("Few of the {} that decided pass them ({}).", counted(facts.met.trips, "trip"),
                       fmt::join(by_rank, ", "));
}

/// `Not chosen: #2, which gains 7.4 s alone, adds 0.4 [-0.5, 1.4] s beside #4.`, of those that gain more
/// alone than one that was chosen.
std::string passed_over_sentence(const EquipmentFacts& facts) {
    constexpr std::size_t most_told = 3;
    double least_s = std::numeric_limits<double>::infinity();
    for (const EquipCandidateFacts& one : facts.candidates)
        if (one.rank && one.gain) least_s = std::min(least_s, one.gain->mean);
    std::vector<EquipCandidateFacts> passed_over;
    for (const EquipCandidateFacts& one : facts.candidates)
        if (!one.rank && one.later.ranks > 0 && one.gain && one.gain->mean > least_s)
            passed_over.push_back(one);
    std::ranges::stable_sort(passed_over, std::greater{},
                             [](const EquipCandidateFacts& one) { return one.gain->mean; });
    passed_over.resize(std::min(passed_over.size(), most_told));
    const auto words = core::texts_of(passed_over, [&](const EquipCandidateFacts& one) {
        return fmt::format("#{}, which gains {:.1f} s alone, adds {} s beside {}", one.number, one.gain->mean,
                           estimate_or_dash(one.later.gain), hashed(first_numbers(facts, one.later.ranks)));
    });
    return words.empty() ? "" : fmt::format("Not chosen: {}.", fmt::join(words, "; "));
}

/// Why no number of seeds makes more of a map that has little to choose from.
std::string small_map_sentence(const EquipmentFacts& facts) {
    const std::string why = small_map_of(facts);
    if (why.empty()) return "";
    return fmt::format(
        "More seeds would narrow the ranges, but find no order on this map: {}. What helps: the signals that "
        "the map lacks, your stations, your calls, or a larger map.",
        why);
}

/// Where no EV was a step faster or slower, seeds of the same kind would not show more.
std::string no_effect_sentence(const EquipmentFacts& facts) {
    return is_exactly_none(facts.ranked.back().so_far)
               ? "In these runs no trip of an EV was changed: they say nothing of what signals are worth."
               : "";
}

/// Numbers of the chosen signals of which it holds.
template <class Holds>
std::vector<std::size_t> numbers_where(const EquipmentFacts& facts, const Holds& holds) {
    std::vector<std::size_t> numbers;
    for (const EquippedSignal& signal : facts.ranked)
        if (holds(signal)) numbers.push_back(signal.number);
    return numbers;
}

/// Signals that decided nothing for an EV of the fresh seeds: their places are chance, but of a pair the
/// other may have all of its gain.
std::string unchanged_sentence(const EquipmentFacts& facts) {
    if (is_exactly_none(facts.ranked.back().so_far)) return "";
    const auto by_chance = numbers_where(facts, [&](const auto& one) { return is_chance(facts, one); });
    const auto of_pairs = numbers_where(
        facts, [&](const auto& one) { return is_exactly_none(one.gain) && pair_of(facts, one) != nullptr; });
    std::string text;
    if (!by_chance.empty())
        text = fmt::format("{} changed no trip of the fresh seeds: {} chance. ", hashed(by_chance),
                           by_chance.size() == 1 ? "its place is" : "their places are");
    if (!of_pairs.empty())
        text += fmt::format("{} added nothing to those before in the fresh seeds. ", hashed(of_pairs));
    if (!text.empty()) text.pop_back();
    return text;
}

std::string end_sentence(const EquipmentFacts& facts) {
    if (facts.ranked.empty() || facts.end == EquipEnd::budget) return "";
    if (facts.end == EquipEnd::exhausted) return "Every signal that could gain is equipped.";
    return fmt::format("Stopped at {} of {}: in the mean of the runs no other signal adds a gain.",
                       facts.ranked.size(), facts.budget);
}

std::string share_sentence(const EquipmentFacts& facts) {
    if (!is_shown(facts.all_gain)) return "The gain of all signals is not shown to be above 0.";
    if (facts.ranked.empty() || !has_order(facts)) return "";
    if (const auto rank = rank_with_share(facts, great_share))
        return fmt::format("{} of {} bring {:.0f} % of the gain of all.", *rank,
                           counted(facts.signals, "signal"), great_share * 100.0);
    return fmt::format("These do not bring {:.0f} % of the gain of all.", great_share * 100.0);
}

/// What gains count from.
const char* start_of(const EquipmentFacts& facts) {
    return facts.equipped_today.empty() ? "no signal equipped" : "those equipped today";
}

/// ` (about 24 would likely)`; empty where so many are not worth it.
std::string pairs_words(const EquipmentFacts& facts) {
    const std::size_t pairs = pairs_to_tell(facts);
    if (pairs == 0 || !small_map_of(facts).empty()) return "";
    if (pairs > analysis::most_equip_replications)
        return fmt::format(" (more than {} would have to)", analysis::most_equip_replications);
    return fmt::format(" (about {} would likely)", pairs);
}

std::string not_shown_sentence(const EquipmentFacts& facts) {
    const auto numbers = numbers_where(facts, [&](const EquippedSignal& one) {
        return !is_shown_of(facts, one) && !is_exactly_none(one.gain);
    });
    if (numbers.empty()) return "";
    const bool is_none_shown = std::ranges::none_of(
        facts.ranked, [&](const EquippedSignal& one) { return is_shown_of(facts, one); });
    const std::string which =
        is_none_shown && facts.ranked.size() > 1 ? "any of them" : hashed(numbers, " or ");
    if (facts.replications < analysis::fewest_for_interval)
        return fmt::format("Not shown: what {} adds; that takes {} seeds.", which,
                           analysis::fewest_for_interval);
    return fmt::format("Not shown: what {} adds to those before{}.{}", which,
                       is_shown(facts.ranked.back().so_far) ? ", though their sum is" : "",
                       has_order(facts) ? " More --seeds tell." : "");
}

/// `Equip first: 1) #4 Via Po / Via Roma, 2) #9 S5 (not shown).`, numbered as the map and the table of
/// ranks are; what changed no trip is left out.
std::string order_headline(const EquipmentFacts& facts) {
    std::string text = "Equip first";
    const char* before = ": ";
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank) {
        const EquippedSignal& signal = facts.ranked[rank];
        if (is_chance(facts, signal)) continue;
        text += fmt::format("{}{}) {}{}", before, rank + 1, numbered_name(signal),
                            is_shown_of(facts, signal) ? "" : " (not shown)");
        before = ", ";
    }
    return text + ".";
}

/// The answer in a sentence.
std::string headline(const EquipmentFacts& facts) {
    if (has_order(facts)) return order_headline(facts);
    if (most_are_held_up(facts.unsound)) return "No order is shown: locks hold up most fresh runs.";
    const EquippedSignal& last = facts.ranked.back();
    const std::size_t pairs = last.so_far ? last.so_far->n : 0;
    if (tells_sum(facts))
        return fmt::format(
            "No order is shown: together the {} chosen bring {} s a trip; which of them first, "
            "{} cannot tell{}.",
            facts.ranked.size(), estimate_or_dash(last.so_far), counted(pairs, "pair"), pairs_words(facts));
    if (tells_passing(facts))
        return fmt::format(
            "EVs that pass a chosen signal gain {} s each, {} of {}; over all trips no gain is shown, and {} "
            "cannot tell which to equip first.",
            estimate_or_dash(facts.split.passing_gain), facts.split.passing,
            counted(facts.split.trips, "trip"), counted(pairs, "pair"));
    return fmt::format(
        "No gain is shown: {} cannot tell which to equip first{}.", counted(pairs, "pair"),
        is_chance(facts, facts.ranked.front()) ? ", and the first choice changed no trip" : "");
}

/// Those that were chosen, by number, where the headline does not name them.
std::string chosen_sentence(const EquipmentFacts& facts) {
    if (has_order(facts)) return "";
    std::vector<EquippedSignal> chosen = facts.ranked;
    std::ranges::sort(chosen, {}, &EquippedSignal::number);
    return fmt::format("Chosen{}: {}.", chosen.size() > 1 ? ", in no order" : "",
                       fmt::join(core::texts_of(chosen, numbered_name), "; "));
}

std::string gain_sentence(const EquipmentFacts& facts) {
    const EquippedSignal& last = facts.ranked.back();
    if (tells_sum(facts))
        return fmt::format("Gains count from {}. With these signals, {}.", start_of(facts),
                           others_words(facts));
    return fmt::format("Together, an EV needs {} s less a trip than with {} ({}), and {}.",
                       estimate_or_dash(last.so_far),
                       facts.equipped_today.empty() ? "none" : "those of today", shown_word(last.so_far),
                       others_words(facts));
}

/// Where the gain is more than red without queues costs, which the outlook tells.
std::string queues_sentence(const EquipmentFacts& facts) {
    const analysis::MaybeEstimate& gain = facts.ranked.back().so_far;
    if (facts.red_s <= 0.0 || !is_shown(gain) || gain->mean <= facts.red_s) return "";
    return fmt::format("Red alone costs {:.0f} s of a trip: the rest of the gain is queues, or chance.",
                       facts.red_s);
}

std::string left_out_sentence(std::size_t count, const char* why) {
    return count == 0 ? "" : fmt::format("Left out: {} that {}.", counted(count, "signal"), why);
}

}  // namespace

namespace detail {

analysis::MaybeEstimate without_interval(analysis::MaybeEstimate value) {
    if (value) value->interval.reset();
    return value;
}

std::vector<std::string> findings_of(const EquipmentFacts& facts) {
    std::vector<std::string> sentences;
    if (facts.candidates.empty()) {
        sentences.emplace_back("No signal could gain.");
    } else if (facts.ranked.empty()) {
        sentences.push_back(fmt::format("No signal to equip: in the mean of the runs none of the {} gains.",
                                        counted(facts.candidates.size(), "candidate")));
    } else {
        sentences = {headline(facts),
                     has_order(facts) ? "" : small_map_sentence(facts),
                     chosen_sentence(facts),
                     gain_sentence(facts),
                     queues_sentence(facts),
                     split_sentence(facts),
                     no_effect_sentence(facts),
                     together_sentence(facts),
                     not_shown_sentence(facts),
                     unchanged_sentence(facts),
                     passed_over_sentence(facts),
                     few_trips_sentence(facts),
                     seeds_sentence(facts)};
    }
    sentences.push_back(unsound_sentence(facts));
    sentences.push_back(end_sentence(facts));
    sentences.push_back(share_sentence(facts));
    std::erase(sentences, "");
    return sentences;
}

std::string study_command(const EquipmentFacts& facts) {
    if (facts.ranked.empty() || facts.study.empty()) return "";
    std::vector<std::string> signals = facts.equipped_today;
    const bool are_all_chance = std::ranges::all_of(
        facts.ranked, [&](const EquippedSignal& signal) { return is_chance(facts, signal); });
    for (const EquippedSignal& signal : facts.ranked)
        if (are_all_chance || !is_chance(facts, signal)) signals.push_back(fmt::format("#{}", signal.number));
    std::vector<std::string> words = facts.study;
    const std::size_t to_show = seeds_to_show(facts);
    const std::size_t seeds = to_show <= analysis::most_equip_replications
                                  ? std::max<std::size_t>(to_show, facts.replications)
                                  : facts.replications;
    if (seeds > analysis::fewest_replications)
        words = core::with_option(words, "--seeds", std::to_string(seeds));
    if (facts.unsound.say_little())
        words = core::with_option(words, "--density", less_density(facts.density));
    words.insert(words.end(), {"--set", fmt::format("actuation.equipped={}", fmt::join(signals, ","))});
    return printable(core::shell_text(words));
}

std::string study_words(const EquipmentFacts& facts) {
    return fmt::format("To study these signals on other seeds{}:",
                       facts.unsound.say_little() ? " and with less traffic" : "");
}

std::string more_seeds_command(const EquipmentFacts& facts) {
    if (facts.ranked.empty() || has_order(facts) || most_are_held_up(facts.unsound) ||
        !small_map_of(facts).empty())
        return "";
    const std::size_t seeds = tells_sum(facts) ? pairs_to_tell(facts) : seeds_to_show(facts);
    if (seeds <= facts.replications || seeds > analysis::most_equip_replications) return "";
    return printable(core::shell_text(core::with_option(facts.more_seeds, "--seeds", std::to_string(seeds))));
}

std::string signals_alone_sentence(const EquipmentFacts& facts) {
    if (facts.other_parts.empty()) return "";
    return fmt::format(
        "{} of {} {} also where no signal is equipped. For signals alone in today's traffic: --policy "
        "preempt_signals --av-share 0.",
        fmt::join(facts.other_parts, " and "), facts.condition,
        facts.other_parts.size() == 1 ? "works" : "work");
}

std::vector<std::string> circumstances_of(const EquipmentFacts& facts) {
    std::vector<std::string> sentences = {
        facts.budget > facts.signals ? fmt::format("The budget is {}, and the scenario has only {}.",
                                                   facts.budget, counted(facts.signals, "signal"))
                                     : "",
        left_out_sentence(facts.not_passed, "no EV passes in these seeds"),
        left_out_sentence(facts.less_red, "cost EVs less red than the candidates, by their programs"),
        left_out_sentence(facts.switched_off, "the scenario's preemption parameters switch off"),
        facts.equipped_today.empty()
            ? ""
            : fmt::format("Equipped today: {}; EVs pass {} of them.",
                          printable(fmt::format("{}", fmt::join(facts.equipped_today, ", "))),
                          facts.equipped_and_passed),
        fmt::format("EV time, s: baseline {}, {} {}, all signals {}, alone {}. Gains count from {}.",
                    estimate_or_dash(facts.baseline_s), start_of(facts), estimate_or_dash(facts.none_s),
                    estimate_or_dash(facts.all_s), estimate_or_dash(facts.alone_s), start_of(facts)),
        facts.assumptions,
        fmt::format("{}.", counted(facts.runs, "run"))};
    std::erase(sentences, "");
    return sentences;
}

std::string candidate_legend(const EquipmentFacts& facts) {
    const bool left_race = std::ranges::any_of(facts.candidates, &EquipCandidateFacts::left_race);
    return fmt::format(
        "Each candidate alone, seed {}. Trips: share of the EV trips that pass it. Gain: less restricted "
        "mean "
        "travel time of the EVs, paired by seed [95 %, all rows together (Bonferroni), from {} pairs on].{}",
        facts.seed, analysis::fewest_for_interval,
        left_race ? " One with fewer seeds was shown to gain less than another." : "");
}

std::string pair_legend() {
    return "Neighbours on the ways of the EVs, tried together in the same race: half of what both gain.";
}

std::string ranks_legend(const EquipmentFacts& facts) {
    return fmt::format(
        "{}Gain: over the rows before, in fresh runs, seed {}, so that the choice does not flatter it [95 %, "
        "all rows together (Bonferroni)].",
        has_order(facts) ? "" : "Steps of the search; no order is shown. ", facts.fresh_seed);
}

std::string curve_legend(const EquipmentFacts& facts) {
    const std::string rows =
        facts.ranked.empty()
            ? fmt::format("All {}", counted(facts.signals, "signal"))
            : fmt::format("Row 2: the signals of {} 1 and 2 together, and so on; last row: all {}",
                          has_order(facts) ? "ranks" : "steps", counted(facts.signals, "signal"));
    return fmt::format("{}. Gains over {}, with intervals of 95 % each{}.{}", rows, start_of(facts),
                       facts.ranked.size() > 1 ? "; those above are wider, to hold together" : "",
                       is_shown(facts.all_gain) ? " %: of the gain of all." : "");
}

std::string event_legend(const EquipmentFacts& facts) {
    return fmt::format("Fresh runs with {}, with all chosen, and the difference [95 %].{}", start_of(facts),
                       collide_by_model(facts.unsound.collisions, facts.unsound.vehicles)
                           ? " So many collisions are made by the model of drivers: they say nothing of "
                             "safety."
                           : "");
}

}  // namespace detail

std::string UnsoundRuns::words() const {
    std::vector<std::string> words;
    if (locked > 0)
        words.push_back(fmt::format("vehicles locked each other in {} of {}, {} held up by it", locked,
                                    counted(runs, "run"), held_up == 0 ? "none" : std::to_string(held_up)));
    if (lost_vehicles > 0) words.push_back(fmt::format("{} did not arrive", counted(lost_vehicles, "EV")));
    return fmt::format("{}", fmt::join(words, ", and "));
}

std::string small_map_words(std::size_t equipped, std::size_t passed, const SignalsMet& met) {
    std::vector<std::string> why;
    if (equipped + 1 >= passed)
        why.push_back(fmt::format("{} {} nearly all of its {} that EVs pass", equipped,
                                  equipped == 1 ? "is" : "are", counted(passed, "signal")));
    if (2 * met.trips_with_signals < met.trips)
        why.push_back(
            fmt::format("only {} of {} pass one", met.trips_with_signals, counted(met.trips, "EV trip")));
    return fmt::format("{}", fmt::join(why, ", and "));
}

std::string SignalsMet::words() const {
    if (trips == 0) return "No EV has a trip in these seeds.";
    return fmt::format(
        "{:.0f} % of the EVs' {} that decide pass at least one signal; a trip meets {:.1f} on average.",
        100.0 * *share(), core::counted(trips, "trip"), *mean());
}

}  // namespace clearway::report
