#include "report/locks.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace clearway::report {
namespace {

std::string needed(const MaybeEstimate& difference, double half_width) {
    if (!difference || difference->n < 2) return "unknown";
    return replications_words(analysis::advised_replications(difference->deviation, half_width));
}

}  // namespace

std::string less_density(double density) {
    return fmt::format("{:.2g}", less_traffic_factor * density);
}

std::string lock_remedy(Blockers blockers, const std::string& less) {
    if (blockers == Blockers::ignored)
        return fmt::format("less traffic: {}, or a look at the junction in netedit", less);
    return fmt::format(
        "--ignore-junction-blocker 10 (to keep it, ignore_junction_blocker_s in [time] of scenario.toml), or "
        "less traffic: {}",
        less);
}

std::string longest_words(std::uint64_t locks, double longest_s) {
    return fmt::format("{}{:.0f} s", locks == 1 ? "of " : "the longest ", longest_s);
}

std::string lock_words(const analysis::ConditionSummary& condition) {
    const std::size_t locked = condition.locked_runs();
    if (locked == 0) return {};
    const auto total = [&](const char* metric) {
        return static_cast<std::uint64_t>(condition.total(metric));
    };
    double longest_s = 0.0;
    for (const std::optional<double>& value : condition.metric("longest_lock_s").values)
        longest_s = std::max(longest_s, value.value_or(0.0));
    const std::uint64_t locks = total("locks");
    std::string words = fmt::format("{} in {} of {}, {}; {} stood in {}", counted(locks, "lock"), locked,
                                    counted(condition.complete_runs, "run"), longest_words(locks, longest_s),
                                    counted(total("locked_vehicles"), "vehicle"), locks == 1 ? "it" : "them");
    const std::uint64_t emergency = total("locked_emergency_vehicles");
    return words + (emergency == 0 ? "" : fmt::format(", {} of them EV", grouped(emergency)));
}

std::string locked_pairs_words(const analysis::Comparison& comparison, double half_width, Script script) {
    if (comparison.locked_pairs == 0 || !comparison.difference) return {};
    const NumberStyle style{.decimals = 1, .script = script, .sign = Sign::always};
    const std::uint64_t unlocked = comparison.complete_pairs - comparison.locked_pairs;
    if (unlocked < analysis::fewest_for_interval)
        return fmt::format("mean {}, median of pairs {}; {} without a lock",
                           number(comparison.difference->mean, style),
                           number_or_dash(comparison.median, style),
                           unlocked == 0   ? "no pair is"
                           : unlocked == 1 ? "only 1 pair is"
                                           : fmt::format("only {} pairs are", unlocked));
    return fmt::format(
        "mean {}, median of pairs {}, mean of the {} without a lock {}; replications for "
        "{}{:g}: {}, without locks {}",
        number(comparison.difference->mean, style), number_or_dash(comparison.median, style),
        counted(unlocked, "pair"), estimate(comparison.unlocked, style),
        script == Script::plain ? "+-" : "\u00b1", half_width, needed(comparison.difference, half_width),
        needed(comparison.unlocked, half_width));
}

}  // namespace clearway::report
