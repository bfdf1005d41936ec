// What a council is told of the runs of `clearway equip`: no term of the field and no bracket.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/detail/equipment_order.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

using analysis::MaybeEstimate;

/// `110 s`, `2.4 s`, without a sign.
std::string seconds(double value_s) {
    return fmt::format("{:.{}f} s", std::abs(value_s), std::abs(value_s) < 10.0 ? 1 : 0);
}

/// A difference and its range in words; `more` and `less` say what a value above and below 0 is.
std::string told(const MaybeEstimate& value, const char* more, const char* less) {
    if (!value) return "not measured";
    const auto side = [&](double of) { return of < 0.0 ? less : more; };
    const std::string mean = fmt::format("{} {}", seconds(value->mean), side(value->mean));
    const analysis::Interval* const range = analysis::shown_interval(value);
    if (range == nullptr) return fmt::format("{}, from too few simulations for a range", mean);
    if (range->low * range->high > 0.0) {
        const auto [least, most] = std::minmax({std::abs(range->low), std::abs(range->high)});
        constexpr double next_to_nothing = 0.05;  // of the mean
        const bool is_barely_shown = least < next_to_nothing * std::abs(value->mean);
        return fmt::format("{} ({} to {}{})", mean, seconds(least), seconds(most),
                           is_barely_shown ? ": it may be next to nothing" : "");
    }
    return fmt::format("{} (from {} {} to {} {}: it may be chance)", mean, seconds(range->low), less,
                       seconds(range->high), more);
}

/// The first ones of the search that bring what is shown, where it is not shown that others add to it.
std::string enough_of(const EquipmentFacts& facts) {
    const auto is_enough = std::ranges::find_if(
        facts.ranked, [](const EquippedSignal& signal) { return is_shown(signal.so_far); });
    if (is_enough == facts.ranked.end() || std::next(is_enough) == facts.ranked.end()) return "";
    const auto adds = [&](const EquippedSignal& signal) { return is_shown_of(facts, signal); };
    if (std::any_of(std::next(is_enough), facts.ranked.end(), adds)) return "";
    std::vector<std::string> numbers;
    for (auto signal = facts.ranked.begin(); signal != std::next(is_enough); ++signal)
        numbers.push_back(fmt::format("#{}", signal->number));
    return fmt::format(" As far as is shown, {} {} enough.", fmt::join(numbers, " and "),
                       numbers.size() == 1 ? "is" : "are");
}

std::string what_to_equip(const EquipmentFacts& facts) {
    std::vector<EquippedSignal> chosen = facts.ranked;
    if (!has_order(facts)) std::ranges::sort(chosen, {}, &EquippedSignal::number);
    std::vector<std::string> names;
    for (const EquippedSignal& signal : chosen) {
        if (is_chance(facts, signal)) continue;
        const bool is_doubtful = has_order(facts) && !is_shown_of(facts, signal);
        names.push_back(numbered_name(signal) + (is_doubtful ? " (its own gain is not shown)" : ""));
    }
    if (names.empty()) return "No recommendation: no simulated ambulance was faster by any of them.";
    if (has_order(facts)) return fmt::format("Equip first {}.", fmt::join(names, ", then "));
    const std::string all = fmt::format("{}", fmt::join(names, "; "));
    if (most_are_held_up(facts.unsound))
        return fmt::format(
            "No recommendation: traffic blocked itself in most simulations. The best guess: {}.", all);
    if (tells_sum(facts))
        return fmt::format("Equip {}. Which of them first, the simulations do not tell.{}", all,
                           enough_of(facts));
    if (tells_passing(facts))
        return fmt::format("The best guess: {}. They help those who pass them; few do.", all);
    return fmt::format("No recommendation: that ambulances gain is not shown. The best guess: {}.", all);
}

std::string what_it_brings(const EquipmentFacts& facts) {
    const analysis::GainSplit& split = facts.split;
    std::string text;
    if (split.passing > 0)
        text = fmt::format("An ambulance that passes one of them ({} of {}) arrives {}. ", split.passing,
                           counted(split.trips, "trip"), told(split.passing_gain, "sooner", "later"));
    return text + fmt::format("In the mean of all trips{}: {}.",
                              facts.none_s ? fmt::format(", which take {}", seconds(facts.none_s->mean)) : "",
                              told(facts.ranked.back().so_far, "sooner", "later"));
}

std::string how_sure(const EquipmentFacts& facts) {
    std::string text = fmt::format(
        "{} simulations with them and {} without, of the same traffic. The ranges cover chance among such "
        "simulations (95 %), not whether your traffic, signal programs and calls are like those simulated, "
        "which stand below.",
        facts.replications, facts.replications);
    if (facts.unsound.say_little()) text += fmt::format(" A doubt: {}.", facts.unsound.words());
    return text;
}

std::string what_would_help(const EquipmentFacts& facts) {
    if (!has_order(facts) && !small_map_of(facts).empty())
        return "To know more: your signals' programs, your stations, your calls, or a larger map.";
    const std::size_t seeds = tells_sum(facts) ? pairs_to_tell(facts) : seeds_to_show(facts);
    if (!has_order(facts) && seeds > facts.replications && seeds <= analysis::most_equip_replications)
        return fmt::format("To know more: {} simulations of each, your signals' programs and your stations.",
                           seeds);
    return "To know more: your signals' programs, your stations and your counts of traffic.";
}

}  // namespace

std::vector<std::string> council_lines(const EquipmentFacts& facts) {
    if (facts.ranked.empty()) return {};
    return {what_to_equip(facts), what_it_brings(facts),
            fmt::format("Everybody else, a trip: {}.",
                        told(facts.ranked.back().others, "more delay", "less delay")),
            how_sure(facts), what_would_help(facts)};
}

}  // namespace clearway::report::detail
