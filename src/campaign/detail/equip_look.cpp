#include "campaign/detail/equip_look.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/terminal.hpp"
#include "report/text.hpp"

namespace clearway::campaign::detail {

analysis::MaybeEstimate less_time(const analysis::Values& before, const analysis::Values& after,
                                  double level) {
    return analysis::estimate_paired(before, after, analysis::MetricKind::quantity, level);
}

std::string interim_words(const Look& look, const Signals& signals) {
    constexpr std::size_t most_told = 5;
    if (look.sets.size() < 2) return "clearway: no look is complete: no gain can be told yet\n";
    std::vector<std::pair<analysis::MaybeEstimate, std::size_t>> gains;
    for (std::size_t set = 1; set < look.sets.size(); ++set)
        if (look.sets[set].size() == look.sets.front().size() + 1)
            gains.emplace_back(less_time(look.values.front(), look.values[set]), look.sets[set].back());
    std::ranges::stable_sort(gains, std::greater{},
                             [](const auto& one) { return analysis::mean_of(one.first).value_or(-1e30); });
    gains.resize(std::min(gains.size(), most_told));
    const auto name = [&](std::size_t candidate) {
        const std::string& streets = signals.streets(candidate);
        return fmt::format(
            "No. {} {}", signals.number(candidate),
            streets.empty() ? report::short_signal_name(signals.id(candidate)) : report::printable(streets));
    };
    std::string text =
        fmt::format("clearway: no ranking yet; the last complete look, {} seeds", look.replications);
    if (!look.sets.front().empty())
        text += fmt::format(", beside those chosen so far, {}, which gain {} s",
                            core::listed(core::texts_of(look.sets.front(), name)),
                            report::estimate(less_time(look.none, look.values.front()), {}));
    text += ". Gains, s, of which the largest flatters itself:\n";
    for (const auto& [gain, candidate] : gains)
        text += core::wrapped(fmt::format("  {}: {}", name(candidate), report::estimate(gain, {})), 4) + "\n";
    return text;
}

}  // namespace clearway::campaign::detail
