#include "report/equipment.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/terminal.hpp"
#include "report/detail/equipment_order.hpp"
#include "report/detail/equipment_sheets.hpp"
#include "report/detail/json.hpp"
#include "report/detail/side_files.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using analysis::EquipEnd;
using detail::great_share;
using detail::Json;
using detail::Share;
using detail::Sheet;
using detail::SheetCell;
using Where = detail::SheetColumn::Shown;

EquippedSignal all_of(const EquipmentFacts& facts) {
    return {0, "all signals", "", std::nullopt, facts.all_gain, facts.all_others};
}

SheetCell count_or_nothing(std::size_t count) {
    return count > 0 ? SheetCell(count) : SheetCell();
}

SheetCell share_cell(const EquipmentFacts& facts, const EquippedSignal& signal) {
    const std::optional<double> share = share_of_all(facts, signal);
    return share ? SheetCell(Share{*share}) : SheetCell();
}

std::vector<detail::SheetColumn> ranked_columns() {
    std::vector<detail::SheetColumn> columns;
    for (const char* const key : {"equipped", "number", "signal", "streets", "gain_s", "shown",
                                  "gain_so_far_s", "share_of_all", "others_time_loss_s", "gain_chosen_by_s"})
        columns.push_back({key, ""});
    return columns;
}

/// What people call a signal. Ids of joined junctions name all their nodes, and have no end.
template <class Facts>
std::string name_of(const Facts& one) {
    constexpr std::size_t longest_id = 60;
    return one.streets.empty() && one.signal.size() <= longest_id ? one.signal
                                                                  : signal_words(one.signal, one.streets);
}

/// `equipped`: with how many signals the row ends.
std::vector<SheetCell> ranked_row(const EquipmentFacts& facts, std::size_t equipped,
                                  const EquippedSignal& signal) {
    return {equipped,      count_or_nothing(signal.number),
            signal.signal, signal.streets,
            signal.gain,   signal.number > 0 ? SheetCell(is_shown(signal.gain)) : SheetCell(),
            signal.so_far, share_cell(facts, signal),
            signal.others, signal.chosen_by};
}

Sheet ranked_sheet(const EquipmentFacts& facts) {
    Sheet sheet{ranked_columns(), {}};
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        sheet.rows.push_back(ranked_row(facts, rank + 1, facts.ranked[rank]));
    return sheet;
}

/// A row of what `equipped` signals bring together.
std::vector<SheetCell> sum_row(const EquipmentFacts& facts, std::size_t equipped, const EquippedSignal& sum) {
    return {equipped, sum.so_far, is_shown(sum.so_far), share_cell(facts, sum),
            detail::others_cell(facts, sum.others)};
}

template <class Facts>
double gain_or_least(const Facts& one) {
    return analysis::mean_of(one.gain).value_or(std::numeric_limits<double>::lowest());
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

Sheet ranks_table(const EquipmentFacts& facts) {
    Sheet table{{{"", has_order(facts) ? "Rank" : "Step"},
                 {"", "Signal"},
                 {"", "Gain, s"},
                 {"", "Effect"},
                 {"", "Streets"}},
                {}};
    for (const EquippedSignal& signal : facts.ranked)
        table.rows.push_back({table.rows.size() + 1, SignalNumber{signal.number}, signal.gain,
                              is_shown(signal.gain), name_of(signal)});
    return table;
}

Sheet curve_table(const EquipmentFacts& facts) {
    Sheet table{{{"", "Signals"},
                 {"", "Gain in all, s"},
                 {"", "Effect"},
                 {"", "%"},
                 {"", others_save(facts) ? "Others save, s" : "Others lose, s", Where::if_room}},
                {}};
    for (const EquippedSignal& signal : facts.ranked)
        table.rows.push_back(sum_row(facts, table.rows.size() + 1, signal));
    table.rows.push_back(sum_row(facts, facts.signals, all_of(facts)));
    return table;
}

Sheet event_sheet(const EquipmentFacts& facts) {
    Sheet sheet{{{"event", "Events of a run"}, {"none", "None"}, {"chosen", "Chosen"}, {"more", "More"}}, {}};
    for (const EquipEventFacts& event : facts.events)
        sheet.rows.push_back(
            {event.title, without_interval(event.none), without_interval(event.chosen), event.more});
    return sheet;
}

Sheet candidate_sheet(const EquipmentFacts& facts) {
    Sheet sheet{{{"number", "Signal"},
                 {"signal", "", Where::in_data},
                 {"streets", "", Where::in_data},
                 {"share_of_trips", "Trips, %"},
                 {"gain_s", "Gain alone, s"},
                 {"shown", "Effect"},
                 {"pairs", "Seeds"},
                 {"left_race", "", Where::in_data},
                 {"rank", has_order(facts) ? "Rank" : "Step"},
                 {"", "Streets"}},
                {}};
    std::vector<EquipCandidateFacts> candidates = facts.candidates;
    std::ranges::stable_sort(candidates, std::greater{}, gain_or_least<EquipCandidateFacts>);
    for (const EquipCandidateFacts& one : candidates)
        sheet.rows.push_back({SignalNumber{one.number}, one.signal, one.streets, Share{one.trips}, one.gain,
                              is_shown(one.gain), one.gain ? one.gain->n : std::size_t{0}, one.left_race,
                              count_or_nothing(one.rank.value_or(0)), name_of(one)});
    return sheet;
}

Sheet pair_sheet(const EquipmentFacts& facts) {
    Sheet sheet{{{"number", "Signal"},
                 {"with", "with"},
                 {"gain_a_signal_s", "Gain a signal, s"},
                 {"shown", "Effect"},
                 {"pairs", "Seeds"},
                 {"left_race", "", Where::in_data},
                 {"chosen", "", Where::in_data}},
                {}};
    std::vector<EquipPairFacts> pairs = facts.pairs;
    std::ranges::stable_sort(pairs, std::greater{}, gain_or_least<EquipPairFacts>);
    for (const EquipPairFacts& one : pairs)
        sheet.rows.push_back({SignalNumber{one.numbers[0]}, SignalNumber{one.numbers[1]}, one.gain,
                              is_shown(one.gain), one.gain ? one.gain->n : std::size_t{0}, one.left_race,
                              one.chosen});
    return sheet;
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
    if (!detail::has_order(facts)) return std::nullopt;
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
        paragraph({facts.met.words()}) + paragraph({printable(facts.outlook)});
    if (const std::string alone = detail::signals_alone_sentence(facts); !alone.empty())
        text += paragraph({alone});
    if (const std::string coarse = coarse_step_sentence(facts.step_length_s); !coarse.empty())
        text += paragraph({coarse});
    if (!facts.candidates.empty())
        text += "\n" + detail::text_of(detail::candidate_sheet(facts)) +
                paragraph({detail::candidate_legend(facts)});
    if (!facts.pairs.empty())
        text += "\n" + detail::text_of(detail::pair_sheet(facts)) + paragraph({detail::pair_legend()});
    if (!facts.ranked.empty())
        text += "\n" + detail::text_of(detail::ranks_table(facts)) + paragraph({detail::ranks_legend(facts)});
    text += "\n" + detail::text_of(detail::curve_table(facts)) + paragraph({detail::curve_legend(facts)});
    if (!facts.events.empty())
        text += "\n" + detail::text_of(detail::event_sheet(facts)) + paragraph({detail::event_legend(facts)});
    text += "\n" + paragraph(detail::circumstances_of(facts)) + "\n" + lines(detail::findings_of(facts));
    if (const std::string command = detail::more_seeds_command(facts); !command.empty())
        text += lines({detail::more_seeds_words}) + command + "\n";
    if (const std::string command = detail::study_command(facts); !command.empty())
        text += lines({detail::study_words(facts)}) + command + "\n";
    return text;
}

std::string equipment_json(const EquipmentFacts& facts) {
    using detail::estimate_json;
    Sheet all{ranked_columns(), {ranked_row(facts, facts.signals, all_of(facts))}};
    const auto rank = rank_with_share(facts, great_share);
    const Json json = {{"scenario", facts.scenario},
                       {"condition", facts.condition},
                       {"command", facts.command},
                       {"seed", facts.seed},
                       {"fresh_seed", facts.fresh_seed},
                       {"replications", facts.replications},
                       {"step_length_s", facts.step_length_s},
                       {"share_of_trips_with_signals", detail::json_of(facts.met.share())},
                       {"signals_per_trip", detail::json_of(facts.met.mean())},
                       {"outlook", facts.outlook},
                       {"budget", facts.budget},
                       {"signals", facts.signals},
                       {"not_passed", facts.not_passed},
                       {"switched_off", facts.switched_off},
                       {"less_red", facts.less_red},
                       {"equipped_today", facts.equipped_today},
                       {"runs", facts.runs},
                       {"fresh_runs", facts.unsound.runs},
                       {"fresh_runs_with_locks", facts.unsound.locked},
                       {"fresh_vehicles_lost", facts.unsound.lost_vehicles},
                       {"baseline_s", estimate_json(facts.baseline_s)},
                       {"none_equipped_s", estimate_json(facts.none_s)},
                       {"all_equipped_s", estimate_json(facts.all_s)},
                       {"fresh_trips", facts.split.trips},
                       {"fresh_trips_passing", facts.split.passing},
                       {"gain_of_passing_s", estimate_json(facts.split.passing_gain)},
                       {"gain_of_not_passing_s", estimate_json(facts.split.other_gain)},
                       {"events", detail::json_of(detail::event_sheet(facts))},
                       {"alone_s", estimate_json(facts.alone_s)},
                       {"candidates", detail::json_of(detail::candidate_sheet(facts))},
                       {"pairs", detail::json_of(detail::pair_sheet(facts))},
                       {"headline", detail::findings_of(facts).front()},
                       {"council", detail::council_lines(facts)},
                       {"order_shown", detail::has_order(facts)},
                       {"ranked", detail::json_of(ranked_sheet(facts))},
                       {"all", detail::json_of(all).front()},
                       {"rank_with_80_percent", rank ? Json(*rank) : Json(nullptr)},
                       {"end", end_word(facts.end)}};
    return detail::to_text(json);
}

std::string equipment_csv(const EquipmentFacts& facts) {
    Sheet sheet = ranked_sheet(facts);
    const analysis::Estimate nothing{};
    sheet.rows.push_back(ranked_row(facts, facts.signals, all_of(facts)));
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
