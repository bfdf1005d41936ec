// What the runs of `clearway equip` show, and what they cannot.

#include "report/detail/equipment_order.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

analysis::MaybeEstimate negated(analysis::MaybeEstimate value) {
    if (!value) return value;
    value->mean = -value->mean;
    if (value->interval) value->interval = analysis::Interval{-value->interval->high, -value->interval->low};
    return value;
}

}  // namespace

bool is_exactly_none(const analysis::MaybeEstimate& gain) {
    return gain && gain->mean == 0.0 && gain->deviation == 0.0;
}

bool most_are_held_up(const UnsoundRuns& unsound) {
    return 2 * unsound.held_up > unsound.runs;
}

const EquipPairFacts* pair_of(const EquipmentFacts& facts, const EquippedSignal& signal) {
    const auto found = std::ranges::find_if(facts.pairs, [&](const EquipPairFacts& pair) {
        return pair.chosen && core::contains(pair.numbers, signal.number);
    });
    return found == facts.pairs.end() ? nullptr : &*found;
}

bool is_shown_of(const EquipmentFacts& facts, const EquippedSignal& signal) {
    const EquipPairFacts* const pair = pair_of(facts, signal);
    return is_shown(signal.gain) || (pair != nullptr && is_shown(pair->both_gain));
}

bool is_chance(const EquipmentFacts& facts, const EquippedSignal& signal) {
    return is_exactly_none(signal.gain) && pair_of(facts, signal) == nullptr;
}

bool has_order(const EquipmentFacts& facts) {
    return !most_are_held_up(facts.unsound) && !facts.ranked.empty() &&
           is_shown_of(facts, facts.ranked.front());
}

bool tells_sum(const EquipmentFacts& facts) {
    return !has_order(facts) && !most_are_held_up(facts.unsound) && is_shown(facts.ranked.back().so_far);
}

bool tells_passing(const EquipmentFacts& facts) {
    return !has_order(facts) && !most_are_held_up(facts.unsound) && !tells_sum(facts) &&
           is_shown(facts.split.passing_gain);
}

bool others_save(const EquipmentFacts& facts) {
    return !facts.ranked.empty() && analysis::mean_of(facts.ranked.back().others).value_or(0.0) < 0.0;
}

analysis::MaybeEstimate others_cell(const EquipmentFacts& facts, const analysis::MaybeEstimate& loss) {
    return others_save(facts) ? negated(loss) : loss;
}

std::size_t seeds_to_show(const EquipmentFacts& facts) {
    const analysis::MaybeEstimate& gain = facts.ranked.back().so_far;
    if (analysis::shown_interval(gain) == nullptr || is_shown(gain) || gain->mean <= 0.0) return 0;
    return analysis::replications_to_show(gain->deviation, gain->mean);
}

std::size_t pairs_to_tell(const EquipmentFacts& facts) {
    const EquipPairFacts* const pair = pair_of(facts, facts.ranked.front());
    const analysis::MaybeEstimate& gain = pair != nullptr ? pair->both_gain : facts.ranked.front().gain;
    if (analysis::shown_interval(gain) == nullptr || gain->mean <= 0.0 || gain->deviation <= 0.0) return 0;
    const double ranks = pair != nullptr ? 1.0 : static_cast<double>(facts.ranked.size());
    return analysis::replications_to_show(gain->deviation, gain->mean,
                                          1.0 - (1.0 - analysis::usual_level) / ranks);
}

std::string small_map_of(const EquipmentFacts& facts) {
    return small_map_words(facts.ranked.size(), facts.candidates.size() + facts.less_red, facts.met);
}

std::string numbered_name(const EquippedSignal& signal) {
    return fmt::format("#{} {}", signal.number, signal_words(signal.signal, signal.streets));
}

}  // namespace clearway::report::detail
