// What `clearway equip` says in sentences, on the terminal and on its page.

#include <algorithm>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/detail/equipment_sheets.hpp"
#include "report/equipment.hpp"
#include "report/locks.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::EquipEnd;
using detail::great_share;

bool is_exactly_none(const analysis::MaybeEstimate& gain) {
    return gain && gain->mean == 0.0 && gain->deviation == 0.0;
}

/// Ranks that changed a trip of the fresh seeds; all where the first did not, as there is no order then.
std::vector<std::size_t> telling_ranks(const EquipmentFacts& facts) {
    std::vector<std::size_t> telling;
    std::vector<std::size_t> all;
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank) {
        all.push_back(rank);
        if (!is_exactly_none(facts.ranked[rank].gain)) telling.push_back(rank);
    }
    return telling.empty() || telling.front() != 0 ? all : telling;
}

/// `1) Via Po / Via Roma, 2) S5`, numbered as the map and the table of ranks are; without an order `Via Po /
/// Via Roma; S5`.
std::string names_of(const EquipmentFacts& facts) {
    const bool has_order = detail::has_order(facts);
    std::vector<std::string> names;
    for (const std::size_t rank : telling_ranks(facts)) {
        const EquippedSignal& signal = facts.ranked[rank];
        const std::string name = signal_words(signal.signal, signal.streets);
        names.push_back(has_order ? fmt::format("{}) {}", rank + 1, name) : name);
    }
    return fmt::format("{}", fmt::join(names, has_order ? ", " : "; "));
}

bool most_are_held_up(const UnsoundRuns& unsound) {
    return 2 * unsound.held_up > unsound.runs;
}

std::size_t rank_of(const EquipmentFacts& facts, std::size_t number) {
    const auto found = std::ranges::find(facts.ranked, number, &EquippedSignal::number);
    return static_cast<std::size_t>(found - facts.ranked.begin()) + 1;
}

const char* shown_word(const analysis::MaybeEstimate& value) {
    return is_shown(value) ? "shown" : "not shown";
}

std::string estimate_or_dash(const analysis::MaybeEstimate& value) {
    return estimate(value, {});
}

/// What the others lose or save.
std::string others_words(const analysis::MaybeEstimate& loss) {
    if (!loss || loss->mean >= 0.0)
        return fmt::format("lose {} s each ({})", estimate_or_dash(loss), shown_word(loss));
    analysis::MaybeEstimate saving = loss;
    saving->mean = -loss->mean;
    if (loss->interval) saving->interval = analysis::Interval{-loss->interval->high, -loss->interval->low};
    return fmt::format("save {} s each ({})", estimate_or_dash(saving), shown_word(saving));
}

std::string together_sentence(const EquipmentFacts& facts) {
    std::vector<std::string> pairs;
    for (const EquipPairFacts& pair : facts.pairs)
        if (pair.chosen)
            pairs.push_back(fmt::format("rank {} with rank {}, which gain {} s ({})",
                                        rank_of(facts, pair.numbers[0]), rank_of(facts, pair.numbers[1]),
                                        estimate_or_dash(pair.both_gain), shown_word(pair.both_gain)));
    return pairs.empty() ? "" : fmt::format("Chosen together: {}.", fmt::join(pairs, "; "));
}

/// Whether it was chosen in a pair, by what both gain.
bool is_of_pair(const EquipmentFacts& facts, const EquippedSignal& signal) {
    return std::ranges::any_of(facts.pairs, [&](const EquipPairFacts& pair) {
        return pair.chosen && std::ranges::find(pair.numbers, signal.number) != pair.numbers.end();
    });
}

/// Whether it changed no trip of the fresh seeds, so that its rank is chance.
bool is_chance(const EquipmentFacts& facts, const EquippedSignal& signal) {
    return is_exactly_none(signal.gain) && !is_of_pair(facts, signal);
}

bool shows_any(const EquipmentFacts& facts) {
    const auto shown = [](const auto& one) { return is_shown(one.gain) || is_shown(one.so_far); };
    return std::ranges::any_of(facts.ranked, shown) ||
           std::ranges::any_of(facts.pairs, [](const EquipPairFacts& pair) {
               return pair.chosen && is_shown(pair.both_gain);
           });
}

/// How many seeds would likely show the gain of all ranks, if it and its spread are what they look like.
std::string seeds_sentence(const EquipmentFacts& facts) {
    const analysis::MaybeEstimate& gain = facts.ranked.back().so_far;
    if (analysis::shown_interval(gain) == nullptr || is_shown(gain)) return "";
    if (gain->mean <= 0.0) return "Their mean is no gain.";
    const std::size_t seeds = analysis::replications_to_show(gain->deviation, gain->mean);
    if (seeds > analysis::most_equip_replications)
        return fmt::format("It would take more than {} seeds to show so small a gain of all.",
                           analysis::most_equip_replications);
    return fmt::format("About {} seeds would likely (80 %) show the gain of all, if it is as it looks.",
                       seeds);
}

/// `On the fresh seeds vehicles locked each other in 4 of 30 runs, 2 held up by it, and 1 EV did not arrive:
/// ...`, or empty.
std::string unsound_sentence(const UnsoundRuns& unsound) {
    std::vector<std::string> words;
    if (unsound.locked > 0)
        words.push_back(fmt::format("vehicles locked each other in {} of {}, {} held up by it",
                                    unsound.locked, counted(unsound.runs, "run"),
                                    unsound.held_up == 0 ? "none" : std::to_string(unsound.held_up)));
    if (unsound.lost_vehicles > 0)
        words.push_back(fmt::format("{} did not arrive", counted(unsound.lost_vehicles, "EV")));
    if (words.empty()) return "";
    const std::string text = fmt::format("On the fresh seeds {}", fmt::join(words, ", and "));
    if (unsound.held_up + unsound.lost_vehicles == 0) return text + ".";
    return fmt::format("{}: such runs say little of signals. Less traffic: {}.", text, less_traffic);
}

/// A rank that few trips pass rests on them alone.
std::string few_trips_sentence(const EquipmentFacts& facts) {
    constexpr double few = 10.0;
    std::map<std::size_t, double> few_trips;  // by rank
    for (const EquipCandidateFacts& candidate : facts.candidates) {
        const double trips = candidate.trips * static_cast<double>(facts.met.trips);
        if (candidate.rank && trips < few) few_trips.emplace(*candidate.rank, trips);
    }
    if (few_trips.empty()) return "";
    std::vector<std::string> words;
    for (const auto& [rank, trips] : few_trips)
        words.push_back(fmt::format("rank {}: {:.0f}", rank, trips));
    return fmt::format("Few of the {} that decided pass them ({}); more --seeds tell.",
                       counted(facts.met.trips, "trip"), fmt::join(words, ", "));
}

/// What a further study sets to equip the ranks that are named; a line of its own can be copied.
std::vector<std::string> setting_lines(const EquipmentFacts& facts) {
    std::vector<std::string> signals = facts.equipped_today;
    for (const std::size_t rank : telling_ranks(facts))
        signals.push_back(fmt::format("#{}", facts.ranked[rank].number));
    return {"For a study of them, by the numbers of the signals:",
            "--set actuation.equipped=" + printable(fmt::format("{}", fmt::join(signals, ",")))};
}

/// Where no EV was a step faster or slower, seeds of the same kind would not show more.
std::string no_effect_sentence(const EquipmentFacts& facts) {
    return is_exactly_none(facts.ranked.back().so_far)
               ? "In these runs no trip of an EV was changed: they say nothing of what signals are worth."
               : "";
}

template <class Holds>
std::vector<std::size_t> ranks_where(const EquipmentFacts& facts, const Holds& holds) {
    std::vector<std::size_t> ranks;
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        if (holds(facts.ranked[rank])) ranks.push_back(rank + 1);
    return ranks;
}

/// Ranks that decided nothing for an EV of the fresh seeds: which signal has them is chance, but of a pair
/// the other may have all of its gain.
std::string unchanged_sentence(const EquipmentFacts& facts) {
    if (is_exactly_none(facts.ranked.back().so_far)) return "";
    const auto by_chance = ranks_where(facts, [&](const auto& one) { return is_chance(facts, one); });
    const auto of_pairs = ranks_where(
        facts, [&](const auto& one) { return is_exactly_none(one.gain) && is_of_pair(facts, one); });
    std::string text;
    if (!by_chance.empty())
        text = fmt::format("Rank {} changed no trip of the fresh seeds: its place is chance. ",
                           fmt::join(by_chance, ", "));
    if (!of_pairs.empty())
        text += fmt::format("Rank {} added nothing to the ranks before it in the fresh seeds. ",
                            fmt::join(of_pairs, ", "));
    if (!text.empty()) text.pop_back();
    return text;
}

std::string not_shown_sentence(const EquipmentFacts& facts) {
    const auto ranks = ranks_where(facts, [&](const auto& one) {
        return !is_shown(one.gain) && !is_exactly_none(one.gain) && !is_of_pair(facts, one);
    });
    if (ranks.empty()) return "";
    const std::string which = ranks.size() == facts.ranked.size()
                                  ? "of any of them"
                                  : fmt::format("of rank {}", fmt::join(ranks, ", "));
    if (facts.replications < analysis::fewest_for_interval)
        return fmt::format("Not shown: the gain {}; that takes {} seeds.", which,
                           analysis::fewest_for_interval);
    return fmt::format("Not shown: the gain {}. Chance could be all of it; more --seeds tell.", which);
}

std::string end_sentence(const EquipmentFacts& facts) {
    if (facts.ranked.empty() || facts.end == EquipEnd::budget) return "";
    if (facts.end == EquipEnd::exhausted) return "Every signal that could gain is equipped.";
    return fmt::format("Stopped at {} of {}: in the mean of the runs no other signal adds a gain.",
                       facts.ranked.size(), facts.budget);
}

std::string share_sentence(const EquipmentFacts& facts) {
    if (!is_shown(facts.all_gain)) return "The gain of all signals is not shown to be above 0.";
    if (facts.ranked.empty()) return "";
    if (const auto rank = rank_with_share(facts, great_share))
        return fmt::format("{} of {} bring {:.0f} % of the gain of all.", *rank,
                           counted(facts.signals, "signal"), great_share * 100.0);
    return fmt::format("These do not bring {:.0f} % of the gain of all.", great_share * 100.0);
}

/// What comes before the names of those that were chosen.
std::string answer_of(const EquipmentFacts& facts) {
    if (detail::has_order(facts)) return "Equip first";
    const char* const why = most_are_held_up(facts.unsound) ? "locks hold up most fresh runs"
                            : is_chance(facts, facts.ranked.front())
                                ? "no gain is shown, and the first choice changed no trip"
                                : "no gain is shown";
    return fmt::format("These runs cannot tell which to equip first: {}. Chosen, in no order", why);
}

/// What gains count from.
const char* start_of(const EquipmentFacts& facts) {
    return facts.equipped_today.empty() ? "no signal equipped" : "those equipped today";
}

std::string left_out_sentence(std::size_t count, const char* why) {
    return count == 0 ? "" : fmt::format("Left out: {} that {}.", counted(count, "signal"), why);
}

}  // namespace

namespace detail {

bool has_order(const EquipmentFacts& facts) {
    return !most_are_held_up(facts.unsound) && shows_any(facts);
}

std::vector<std::string> findings_of(const EquipmentFacts& facts) {
    std::vector<std::string> sentences;
    if (facts.candidates.empty()) {
        sentences.emplace_back("No signal could gain.");
    } else if (facts.ranked.empty()) {
        sentences.push_back(fmt::format("No signal to equip: in the mean of the runs none of the {} gains.",
                                        counted(facts.candidates.size(), "candidate")));
    } else {
        const EquippedSignal& last = facts.ranked.back();
        sentences.push_back(fmt::format("{}: {}.", answer_of(facts), names_of(facts)));
        sentences.push_back(fmt::format(
            "Together, an EV needs {} s less a trip than with {} ({}), and the others {}.",
            estimate_or_dash(last.so_far), facts.equipped_today.empty() ? "none" : "those of today",
            shown_word(last.so_far), others_words(last.others)));
        sentences.push_back(no_effect_sentence(facts));
        sentences.push_back(together_sentence(facts));
        sentences.push_back(not_shown_sentence(facts));
        sentences.push_back(unchanged_sentence(facts));
        sentences.push_back(few_trips_sentence(facts));
        sentences.push_back(seeds_sentence(facts));
    }
    sentences.push_back(unsound_sentence(facts.unsound));
    sentences.push_back(end_sentence(facts));
    sentences.push_back(share_sentence(facts));
    if (!facts.ranked.empty()) std::ranges::move(setting_lines(facts), std::back_inserter(sentences));
    std::erase(sentences, "");
    return sentences;
}

std::vector<std::string> circumstances_of(const EquipmentFacts& facts) {
    std::vector<std::string> sentences = {
        facts.budget > facts.signals ? fmt::format("The budget is {}, and the scenario has only {}.",
                                                   facts.budget, counted(facts.signals, "signal"))
                                     : "",
        left_out_sentence(facts.not_passed, "no EV passes in these seeds"),
        left_out_sentence(facts.seldom_passed, "fewer EVs pass than the candidates"),
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
    return fmt::format(
        "Each candidate alone, seed {}. EVs: share that pass it. Gain: less restricted mean travel time of "
        "the EVs, paired by seed; "
        "[95 %, all rows together (Bonferroni), from {} pairs on]. One with fewer pairs was shown to gain "
        "less than another.",
        facts.seed, analysis::fewest_for_interval);
}

std::string pair_legend() {
    return "Neighbours on the ways of the EVs, tried together in the same race: half of what both gain.";
}

std::string ranked_legend(const EquipmentFacts& facts) {
    return fmt::format(
        "In the order of choice. Gains are of fresh runs, seed {}, so that the choice does not flatter "
        "them: over the ranks before [95 %, all ranks together (Bonferroni)], and so far, over {} [95 %, "
        "each]. %: of the gain of all signals.",
        facts.fresh_seed, start_of(facts));
}

}  // namespace detail

std::string SignalsMet::words() const {
    if (trips == 0) return "No EV has a trip in these seeds.";
    return fmt::format("{:.0f} % of the EVs' {} pass at least one signal; a trip meets {:.1f} on average.",
                       100.0 * *share(), core::counted(trips, "trip"), *mean());
}

}  // namespace clearway::report
