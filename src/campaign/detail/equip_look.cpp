#include "campaign/detail/equip_look.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/terminal.hpp"
#include "report/equipment.hpp"
#include "report/text.hpp"

namespace clearway::campaign::detail {

analysis::MaybeEstimate less_time(const analysis::Values& before, const analysis::Values& after,
                                  double level) {
    return analysis::estimate_paired(before, after, analysis::MetricKind::quantity, level);
}

namespace {

using Gain = std::pair<analysis::MaybeEstimate, std::size_t>;  // of a candidate

std::string name_of(std::size_t candidate, const Signals& signals) {
    return fmt::format("#{} {}", signals.number(candidate),
                       report::signal_words(signals.id(candidate), signals.streets(candidate)));
}

std::string line_of(const std::string& words, const analysis::MaybeEstimate& gain, const char* mark = "") {
    return core::wrapped(fmt::format("  {}: {}{}", words, report::estimate(gain, {}), mark), 4) + "\n";
}

/// The largest first, a line each.
std::string gain_lines(std::vector<Gain> gains, const Signals& signals) {
    constexpr std::size_t most_told = 5;
    std::ranges::stable_sort(gains, std::greater{},
                             [](const Gain& one) { return analysis::mean_of(one.first).value_or(-1e30); });
    gains.resize(std::min(gains.size(), most_told));
    std::string text;
    for (const auto& [gain, candidate] : gains)
        text += line_of(name_of(candidate, signals), gain);
    return text;
}

constexpr const char* flatters = "Gains, s; chance makes the largest look larger:\n";

/// What keeps any of these figures small, and that costs are not told yet.
std::string reserve(const Signals& signals) {
    return core::wrapped(signals.candidates.met.words() +
                             " What the others lose, and locks, the complete answer tells.",
                         0) +
           "\n";
}

}  // namespace

std::string interim_words(const Look& look, const Signals& signals) {
    if (!look.is_complete()) return "clearway: no look is complete: no gain can be told yet\n";
    std::vector<Gain> gains;
    for (std::size_t set = 1; set < look.sets.size(); ++set)
        if (look.sets[set].size() == look.sets.front().size() + 1)
            gains.emplace_back(less_time(look.values.front(), look.values[set]), look.sets[set].back());
    std::string text =
        fmt::format("clearway: no ranking yet; the last complete look, {} seeds", look.replications);
    if (!look.sets.front().empty())
        text += fmt::format(
            ", beside those chosen so far, {}, which gain {} s",
            core::listed(core::texts_of(look.sets.front(),
                                        [&](std::size_t candidate) { return name_of(candidate, signals); })),
            report::estimate(less_time(look.none, look.values.front()), {}));
    return text + ". " + flatters + gain_lines(std::move(gains), signals) + reserve(signals);
}

std::string chosen_words(const analysis::EquipPlan& plan, const Signals& signals) {
    std::string text = "clearway: the search has ended, the fresh seeds that tell its gain have not. ";
    text += plan.steps.empty()
                ? "It chose no signal. "
                : "It chose, in this order, which no gain confirms yet, with what each adds to "
                  "those before it. ";
    text += flatters;
    for (std::size_t rank = 0; rank < plan.steps.size(); ++rank) {
        const analysis::EquipStep& step = plan.steps[rank];
        const std::string with =
            step.partner ? fmt::format(" with #{}, half of what both gain", signals.number(*step.partner))
                         : "";
        text += line_of(fmt::format("{}) {}{}", rank + 1, name_of(step.candidate, signals), with), step.gain,
                        report::is_shown(step.gain) ? ", shown" : ", not shown");
    }
    std::size_t seeds = 0;
    std::vector<Gain> alone;
    for (std::size_t candidate = 0; candidate < plan.candidates.size(); ++candidate)
        alone.emplace_back(plan.candidates[candidate].gain, candidate);
    for (const auto& [gain, candidate] : alone)
        seeds = std::max(seeds, gain ? gain->n : 0);
    return text +
           fmt::format(
               "Each alone, up to {} seeds, {}:\n", seeds,
               seeds < analysis::fewest_for_interval
                   ? fmt::format("too few for intervals, which need {}", analysis::fewest_for_interval)
                   : "with intervals for all rows together (Bonferroni)") +
           gain_lines(std::move(alone), signals) + reserve(signals);
}

}  // namespace clearway::campaign::detail
