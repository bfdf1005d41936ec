#include "report/equipment.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/terminal.hpp"
#include "report/detail/equipment_sheets.hpp"
#include "report/detail/json.hpp"
#include "report/detail/side_files.hpp"
#include "report/locks.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using analysis::EquipEnd;
using detail::Json;
using detail::Share;
using detail::Sheet;
using detail::SheetCell;
using Where = detail::SheetColumn::Shown;

constexpr double great_share = 0.8;

EquippedSignal all_of(const EquipmentFacts& facts) {
    return {0, "all signals", "", std::nullopt, facts.all_gain, facts.all_others};
}

SheetCell count_or_nothing(std::size_t count) {
    return count > 0 ? SheetCell(count) : SheetCell();
}

std::vector<detail::SheetColumn> ranked_columns() {
    return {{"equipped", "#"},
            {"number", "No."},
            {"signal", "Signal"},
            {"streets", "Streets", Where::not_on_terminal},
            {"gain_s", "Gain, s"},
            {"shown", "Effect"},
            {"gain_so_far_s", "So far, s"},
            {"share_of_all", "%"},
            {"others_time_loss_s", "Others lose, s", Where::not_on_terminal},
            {"gain_chosen_by_s", "", Where::in_data}};
}

/// `equipped`: with how many signals the row ends.
std::vector<SheetCell> ranked_row(const EquipmentFacts& facts, std::size_t equipped,
                                  const EquippedSignal& signal) {
    const bool is_signal = signal.number > 0;
    const std::optional<double> share = share_of_all(facts, signal);
    return {equipped,      count_or_nothing(signal.number),
            signal.signal, signal.streets,
            signal.gain,   is_signal ? SheetCell(is_shown(signal.gain)) : SheetCell(),
            signal.so_far, share ? SheetCell(Share{*share}) : SheetCell(),
            signal.others, signal.chosen_by};
}

/// `1) Via Po / Via Roma, 2) S5`, numbered as the map and the table of ranks are.
std::string names_of(const EquipmentFacts& facts) {
    std::vector<std::string> names;
    for (const EquippedSignal& signal : facts.ranked)
        names.push_back(fmt::format(
            "{}) {}", names.size() + 1,
            signal.streets.empty() ? short_signal_name(signal.signal) : printable(signal.streets)));
    return fmt::format("{}", fmt::join(names, ", "));
}

bool is_exactly_none(const analysis::MaybeEstimate& gain) {
    return gain && gain->mean == 0.0 && gain->deviation == 0.0;
}

bool most_are_held_up(const UnsoundRuns& unsound) {
    return 2 * unsound.held_up > unsound.runs;
}

std::size_t rank_of(const EquipmentFacts& facts, std::size_t number) {
    const auto found = std::ranges::find(facts.ranked, number, &EquippedSignal::number);
    return static_cast<std::size_t>(found - facts.ranked.begin()) + 1;
}

template <class Facts>
double gain_or_least(const Facts& one) {
    return analysis::mean_of(one.gain).value_or(std::numeric_limits<double>::lowest());
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

/// What a further study sets to equip all ranks; a line of its own can be copied.
std::vector<std::string> setting_lines(const EquipmentFacts& facts) {
    std::vector<std::string> signals = facts.equipped_today;
    for (const EquippedSignal& rank : facts.ranked)
        signals.push_back(fmt::format("#{}", rank.number));
    return {"For a study of them, by the numbers of the signals:",
            "--set actuation.equipped=" + printable(fmt::format("{}", fmt::join(signals, ",")))};
}

/// Where no EV was a step faster or slower, seeds of the same kind would not show more.
std::string no_effect_sentence(const EquipmentFacts& facts) {
    return is_exactly_none(facts.ranked.back().so_far)
               ? "In these runs no trip of an EV was changed: they say nothing of what signals are worth."
               : "";
}

/// Ranks that decided nothing for an EV of the fresh seeds: which signal has them is chance.
std::string unchanged_sentence(const EquipmentFacts& facts) {
    std::vector<std::size_t> ranks;
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        if (is_chance(facts, facts.ranked[rank])) ranks.push_back(rank + 1);
    if (ranks.empty() || is_exactly_none(facts.ranked.back().so_far)) return "";
    return fmt::format("Rank {} changed no trip of the fresh seeds: its place is chance.",
                       fmt::join(ranks, ", "));
}

std::string not_shown_sentence(const EquipmentFacts& facts) {
    std::vector<std::size_t> ranks;
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank) {
        const EquippedSignal& signal = facts.ranked[rank];
        if (!is_shown(signal.gain) && !is_exactly_none(signal.gain) && !is_of_pair(facts, signal))
            ranks.push_back(rank + 1);
    }
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
    if (!share_of_all(facts, all_of(facts))) return "The gain of all signals is not shown to be above 0.";
    if (facts.ranked.empty()) return "";
    if (const auto rank = rank_with_share(facts, great_share))
        return fmt::format("{} of {} bring {:.0f} % of the gain of all.", *rank,
                           counted(facts.signals, "signal"), great_share * 100.0);
    return fmt::format("These do not bring {:.0f} % of the gain of all.", great_share * 100.0);
}

/// What comes before the names of those that were chosen.
const char* answer_of(const EquipmentFacts& facts) {
    if (most_are_held_up(facts.unsound)) return "Locks hold up most fresh runs, so the order means little";
    if (shows_any(facts)) return "Equip first";
    return is_chance(facts, facts.ranked.front())
               ? "No gain is shown, and the first changed no trip, so no order"
               : "No gain is shown yet; likely best";
}

/// What gains count from.
const char* start_of(const EquipmentFacts& facts) {
    return facts.equipped_today.empty() ? "no signal equipped" : "those equipped today";
}

std::string left_out_sentence(std::size_t count, const char* why) {
    return count == 0 ? "" : fmt::format("Left out: {} that {}.", counted(count, "signal"), why);
}

const char* end_word(EquipEnd end) {
    switch (end) {
        case EquipEnd::budget:
            return "budget";
        case EquipEnd::exhausted:
            return "exhausted";
        case EquipEnd::no_gain:
            break;
    }
    return "no_gain";
}

std::string paragraph(const std::vector<std::string>& sentences) {
    return core::wrapped(fmt::format("{}", fmt::join(sentences, " ")), 0) + "\n";
}

std::string lines(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences)
        text += core::wrapped(sentence, 4) + "\n";
    return text;
}

}  // namespace

namespace detail {

Sheet ranked_sheet(const EquipmentFacts& facts, LastRow last) {
    Sheet sheet{ranked_columns(), {}};
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        sheet.rows.push_back(ranked_row(facts, rank + 1, facts.ranked[rank]));
    if (last == LastRow::all) {
        sheet.rows.push_back(ranked_row(facts, facts.signals, all_of(facts)));
        sheet.rows.back().front() = SheetCell();  // how many they are would look like a rank
    }
    return sheet;
}

Sheet candidate_sheet(const EquipmentFacts& facts) {
    Sheet sheet{{{"number", "No."},
                 {"signal", "Signal"},
                 {"streets", "Streets", Where::not_on_terminal},
                 {"share_of_trips", "EVs, %"},
                 {"gain_s", "Gain alone, s"},
                 {"shown", "Effect"},
                 {"pairs", "Pairs"},
                 {"left_race", "", Where::in_data},
                 {"rank", "Rank"}},
                {}};
    std::vector<EquipCandidateFacts> candidates = facts.candidates;
    std::ranges::stable_sort(candidates, std::greater{}, gain_or_least<EquipCandidateFacts>);
    for (const EquipCandidateFacts& one : candidates)
        sheet.rows.push_back({one.number, one.signal, one.streets, Share{one.trips}, one.gain,
                              is_shown(one.gain), one.gain ? one.gain->n : std::size_t{0}, one.left_race,
                              count_or_nothing(one.rank.value_or(0))});
    return sheet;
}

Sheet pair_sheet(const EquipmentFacts& facts) {
    Sheet sheet{{{"number", "No."},
                 {"with", "with"},
                 {"gain_a_signal_s", "Gain a signal, s"},
                 {"shown", "Effect"},
                 {"pairs", "Pairs"},
                 {"left_race", "", Where::in_data},
                 {"chosen", "", Where::in_data}},
                {}};
    std::vector<EquipPairFacts> pairs = facts.pairs;
    std::ranges::stable_sort(pairs, std::greater{}, gain_or_least<EquipPairFacts>);
    for (const EquipPairFacts& one : pairs)
        sheet.rows.push_back({one.numbers[0], one.numbers[1], one.gain, is_shown(one.gain),
                              one.gain ? one.gain->n : std::size_t{0}, one.left_race, one.chosen});
    return sheet;
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
        facts.programs.empty() ? "" : fmt::format("Rests on {}.", facts.programs),
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

void SignalsMet::add(std::size_t signals_of_trip) {
    ++trips;
    trips_with_signals += signals_of_trip > 0 ? 1 : 0;
    signals += signals_of_trip;
}

std::optional<double> SignalsMet::share() const {
    if (trips == 0) return std::nullopt;
    return static_cast<double>(trips_with_signals) / static_cast<double>(trips);
}

std::optional<double> SignalsMet::mean() const {
    if (trips == 0) return std::nullopt;
    return static_cast<double>(signals) / static_cast<double>(trips);
}

std::string SignalsMet::words() const {
    if (trips == 0) return "No EV has a trip in these seeds.";
    return fmt::format("{:.0f} % of the EVs' trips pass at least one signal; a trip meets {:.1f} on average.",
                       100.0 * *share(), *mean());
}

std::optional<RoadMap> road_map(const results::Store& store, const std::string& scenario) {
    return detail::roads_in(store.scenario_folder(scenario) / "roads.json");
}

bool is_shown(const analysis::MaybeEstimate& gain) {
    const analysis::Interval* const interval = analysis::shown_interval(gain);
    return interval != nullptr && interval->low > 0.0;
}

std::optional<double> share_of_all(const EquipmentFacts& facts, const EquippedSignal& signal) {
    if (!signal.so_far || !is_shown(facts.all_gain)) return std::nullopt;
    return signal.so_far->mean / facts.all_gain->mean;
}

std::optional<std::size_t> rank_with_share(const EquipmentFacts& facts, double share) {
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank) {
        const auto reached = share_of_all(facts, facts.ranked[rank]);
        if (reached && *reached >= share) return rank + 1;
    }
    return std::nullopt;
}

std::string equipment_text(const EquipmentFacts& facts) {
    std::string text =
        paragraph({fmt::format("{}: which signals to equip first, {}, {}", printable(facts.title),
                               facts.condition, counted(facts.replications, "replication"))}) +
        paragraph({facts.met.words()});
    if (const std::string coarse = coarse_step_sentence(facts.step_length_s); !coarse.empty())
        text += paragraph({coarse});
    if (!facts.candidates.empty())
        text += "\n" + detail::text_of(detail::candidate_sheet(facts)) +
                paragraph({detail::candidate_legend(facts)});
    if (!facts.pairs.empty())
        text += "\n" + detail::text_of(detail::pair_sheet(facts)) + paragraph({detail::pair_legend()});
    text += "\n" + detail::text_of(detail::ranked_sheet(facts, detail::LastRow::all)) +
            paragraph({detail::ranked_legend(facts)});
    return text + "\n" + paragraph(detail::circumstances_of(facts)) + "\n" +
           lines(detail::findings_of(facts));
}

std::string equipment_json(const EquipmentFacts& facts) {
    using detail::estimate_json;
    Sheet all{ranked_columns(), {ranked_row(facts, facts.signals, all_of(facts))}};
    const auto rank = rank_with_share(facts, great_share);
    const Json json = {{"scenario", facts.scenario},
                       {"condition", facts.condition},
                       {"seed", facts.seed},
                       {"fresh_seed", facts.fresh_seed},
                       {"replications", facts.replications},
                       {"step_length_s", facts.step_length_s},
                       {"share_of_trips_with_signals", detail::json_of(facts.met.share())},
                       {"signals_per_trip", detail::json_of(facts.met.mean())},
                       {"budget", facts.budget},
                       {"signals", facts.signals},
                       {"not_passed", facts.not_passed},
                       {"switched_off", facts.switched_off},
                       {"seldom_passed", facts.seldom_passed},
                       {"equipped_today", facts.equipped_today},
                       {"runs", facts.runs},
                       {"fresh_runs", facts.unsound.runs},
                       {"fresh_runs_with_locks", facts.unsound.locked},
                       {"fresh_vehicles_lost", facts.unsound.lost_vehicles},
                       {"baseline_s", estimate_json(facts.baseline_s)},
                       {"none_equipped_s", estimate_json(facts.none_s)},
                       {"all_equipped_s", estimate_json(facts.all_s)},
                       {"alone_s", estimate_json(facts.alone_s)},
                       {"candidates", detail::json_of(detail::candidate_sheet(facts))},
                       {"pairs", detail::json_of(detail::pair_sheet(facts))},
                       {"ranked", detail::json_of(detail::ranked_sheet(facts, detail::LastRow::ranked))},
                       {"all", detail::json_of(all).front()},
                       {"rank_with_80_percent", rank ? Json(*rank) : Json(nullptr)},
                       {"end", end_word(facts.end)}};
    return detail::to_text(json);
}

std::string equipment_csv(const EquipmentFacts& facts) {
    Sheet sheet = detail::ranked_sheet(facts, detail::LastRow::all);
    const analysis::Estimate nothing{};
    sheet.rows.back().front() = facts.signals;
    sheet.rows.back()[2] = std::string();
    sheet.rows.insert(sheet.rows.begin(), ranked_row(facts, 0, {0, "", "", std::nullopt, nothing, nothing}));
    return detail::csv_of(sheet);
}

std::string candidates_csv(const EquipmentFacts& facts) {
    return detail::csv_of(detail::candidate_sheet(facts));
}

std::string pairs_csv(const EquipmentFacts& facts) {
    return detail::csv_of(detail::pair_sheet(facts));
}

}  // namespace clearway::report
