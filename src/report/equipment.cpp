#include "report/equipment.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/json.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::EquipEnd;
using detail::Json;

constexpr double great_share = 0.8;

std::string share_text(const std::optional<double>& share) {
    return share ? fmt::format("{:.0f}", *share * 100.0) : "-";
}

std::string row_text(std::string_view rank, const EquipmentFacts& facts, const EquippedSignal& signal) {
    const std::string name = signal.number == 0
                                 ? signal.signal
                                 : fmt::format("{} {}", signal.number, short_signal_name(signal.signal));
    return fmt::format("{:>4}  {:28} {:>19} {:>19} {:>5} {:>19}\n", rank, name, estimate(signal.gain, {}),
                       estimate(signal.so_far, {}), share_text(share_of_all(facts, signal)),
                       estimate(signal.others, {}));
}

EquippedSignal all_of(const EquipmentFacts& facts) {
    return {0, "all signals", std::nullopt, facts.all_gain, facts.all_others};
}

std::string end_sentence(const EquipmentFacts& facts) {
    if (facts.candidates() == 0) return "";
    if (facts.end == EquipEnd::exhausted) return "Every signal that could gain is equipped.\n";
    if (facts.end == EquipEnd::budget || !facts.next) return "";
    const EquippedSignal& next = *facts.next;
    if (!next.gain || !next.gain->interval)
        return fmt::format("Stopped: fewer than two pairs of runs show what signal {} ({}) would gain.\n",
                           next.number, short_signal_name(next.signal));
    return fmt::format("Stopped: the next one, signal {} ({}), shows no effect: {:.2f} s [{:.2f}, {:.2f}].\n",
                       next.number, short_signal_name(next.signal), next.gain->mean, next.gain->interval->low,
                       next.gain->interval->high);
}

std::string budget_sentence(const EquipmentFacts& facts) {
    if (facts.budget <= facts.signals) return "";
    return fmt::format("The budget is {}, and the scenario has only {}.\n", facts.budget,
                       counted(facts.signals, "signal"));
}

std::string left_out_sentence(const EquipmentFacts& facts) {
    std::string text;
    if (facts.not_passed > 0)
        text += fmt::format("Left out: {} of {}, which no EV passes in these seeds.\n", facts.not_passed,
                            counted(facts.signals, "signal"));
    if (facts.switched_off > 0)
        text += fmt::format("Left out: {} that the scenario's preemption parameters switch off.\n",
                            counted(facts.switched_off, "signal"));
    return text;
}

std::string share_sentence(const EquipmentFacts& facts) {
    if (!share_of_all(facts, all_of(facts))) return "The gain of all signals is not shown to be above 0.\n";
    if (const auto rank = rank_with_share(facts, great_share))
        return fmt::format("{} of {} bring {:.0f} % of the gain of all.\n", *rank,
                           counted(facts.signals, "signal"), great_share * 100.0);
    return fmt::format("These do not bring {:.0f} % of the gain of all.\n", great_share * 100.0);
}

Json estimate_json(const MaybeEstimate& estimate) {
    if (!estimate) return nullptr;
    Json json = {{"mean", estimate->mean}, {"pairs", estimate->n}};
    detail::put_ends(json, detail::pointer_to(estimate->interval), "low", "high");
    return json;
}

Json signal_json(const EquipmentFacts& facts, const EquippedSignal& signal) {
    return {{"number", signal.number},
            {"signal", signal.signal},
            {"gain_s", estimate_json(signal.gain)},
            {"gain_so_far_s", estimate_json(signal.so_far)},
            {"share_of_all", detail::json_of(share_of_all(facts, signal))},
            {"others_time_loss_s", estimate_json(signal.others)}};
}

const char* end_word(EquipEnd end) {
    switch (end) {
        case EquipEnd::budget:
            return "budget";
        case EquipEnd::exhausted:
            return "exhausted";
        case EquipEnd::no_effect:
            break;
    }
    return "no_effect";
}

void append_estimate(std::string& line, const MaybeEstimate& estimate) {
    const auto end = [&](double analysis::Interval::*side) {
        return estimate && estimate->interval ? std::optional(*estimate->interval.*side) : std::nullopt;
    };
    line += fmt::format(",{},{},{}", core::csv_cell(mean_of(estimate)),
                        core::csv_cell(end(&analysis::Interval::low)),
                        core::csv_cell(end(&analysis::Interval::high)));
}

void append_row(std::string& csv, std::size_t equipped, const EquipmentFacts& facts,
                const EquippedSignal& signal) {
    csv += fmt::format("{},{},{}", equipped, signal.number == 0 ? "" : std::to_string(signal.number),
                       core::csv_text(signal.signal));
    append_estimate(csv, signal.gain);
    append_estimate(csv, signal.so_far);
    csv += "," + core::csv_cell(share_of_all(facts, signal));
    append_estimate(csv, signal.others);
    csv += "\n";
}

}  // namespace

std::optional<double> share_of_all(const EquipmentFacts& facts, const EquippedSignal& signal) {
    const MaybeEstimate& all = facts.all_gain;
    if (!signal.so_far || !all || !all->interval || all->interval->low <= 0.0) return std::nullopt;
    return signal.so_far->mean / all->mean;
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
        fmt::format("{}: which signals to equip first, {}, {}, seed {}\n\n", printable(facts.title),
                    facts.condition, counted(facts.replications, "replication"), facts.seed);
    text += fmt::format("{:>4}  {:28} {:>19} {:>19} {:>5} {:>19}\n", "Rank", "Signal", "Gain s", "So far s",
                        "%", "Others lose s");
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        text += row_text(std::to_string(rank + 1), facts, facts.ranked[rank]);
    text += row_text("", facts, all_of(facts));
    text += "\n" + budget_sentence(facts) + end_sentence(facts) + left_out_sentence(facts) +
            share_sentence(facts);
    text +=
        fmt::format("EV time s: baseline {}, no signal equipped {},\n           all signals {}, alone {}.\n",
                    estimate(facts.baseline_s, {}), estimate(facts.none_s, {}), estimate(facts.all_s, {}),
                    estimate(facts.alone_s, {}));
    text +=
        "Gain: reduction of the EVs' restricted mean travel time, paired by seed, [95 %] from 5 pairs on;\n"
        "so far: against the same policy with no signal equipped; %: of the gain of all signals; others:\n"
        "increase of their mean time loss. Intervals are not adjusted for the choice of signals: confirm it\n"
        "with another seed.\n";
    return text;
}

std::string equipment_json(const EquipmentFacts& facts) {
    Json ranked = Json::array();
    for (const EquippedSignal& signal : facts.ranked)
        ranked.push_back(signal_json(facts, signal));
    const auto rank = rank_with_share(facts, great_share);
    const Json json = {{"scenario", facts.scenario},
                       {"condition", facts.condition},
                       {"seed", facts.seed},
                       {"replications", facts.replications},
                       {"budget", facts.budget},
                       {"signals", facts.signals},
                       {"not_passed", facts.not_passed},
                       {"switched_off", facts.switched_off},
                       {"sets_measured", facts.measured},
                       {"baseline_s", estimate_json(facts.baseline_s)},
                       {"none_equipped_s", estimate_json(facts.none_s)},
                       {"all_equipped_s", estimate_json(facts.all_s)},
                       {"alone_s", estimate_json(facts.alone_s)},
                       {"all", signal_json(facts, all_of(facts))},
                       {"ranked", ranked},
                       {"rank_with_80_percent", rank ? Json(*rank) : Json(nullptr)},
                       {"end", end_word(facts.end)},
                       {"next", facts.next ? signal_json(facts, *facts.next) : Json(nullptr)}};
    return detail::to_text(json);
}

std::string equipment_csv(const EquipmentFacts& facts) {
    std::string csv =
        "equipped,number,signal,gain_s,gain_low_s,gain_high_s,so_far_s,so_far_low_s,so_far_high_s,"
        "share_of_all,others_s,others_low_s,others_high_s\n";
    const analysis::Estimate nothing{};
    append_row(csv, 0, facts, {0, "", std::nullopt, nothing, nothing});
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank)
        append_row(csv, rank + 1, facts, facts.ranked[rank]);
    append_row(csv, facts.signals, facts, {0, "", std::nullopt, facts.all_gain, facts.all_others});
    return csv;
}

std::string equipment_curve(const EquipmentFacts& facts) {
    const detail::Range numbers(0.0, static_cast<double>(std::max<std::size_t>(facts.ranked.size(), 1)));
    detail::Range gains;
    gains.include(0.0);
    gains.include_all(facts.all_gain);
    for (const EquippedSignal& signal : facts.ranked)
        gains.include_all(signal.so_far);
    detail::Chart plot(fmt::format("{}: gain against number of signals equipped", facts.title), 260.0,
                       detail::padded(numbers, 0.05), "signals equipped", detail::padded(gains, 0.1),
                       "emergency vehicles gain, s a trip");
    plot.horizontal(0.0);
    detail::Points points = {{0.0, 0.0}};
    for (std::size_t rank = 0; rank < facts.ranked.size(); ++rank) {
        const MaybeEstimate& gain = facts.ranked[rank].so_far;
        if (!gain) continue;
        const auto equipped = static_cast<double>(rank + 1);
        points.emplace_back(equipped, gain->mean);
        if (gain->interval) plot.whisker(equipped, {gain->interval->low, gain->interval->high}, {1});
    }
    plot.line(points, {1, detail::Series::Weight::lead});
    std::vector<detail::LegendEntry> legend = {
        detail::line_entry({1, detail::Series::Weight::lead}, "the first signals, with 95 % intervals")};
    if (facts.all_gain) {
        plot.line({{numbers.low, facts.all_gain->mean}, {numbers.high, facts.all_gain->mean}}, {2});
        legend.push_back(detail::line_entry({2}, fmt::format("all of {}", counted(facts.signals, "signal"))));
    }
    plot.legend(legend);
    return detail::standalone(plot.finish());
}

}  // namespace clearway::report
