// What signals on a route showed, as bars beside their stop lines that do not lie on each other.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "report/detail/figures.hpp"

namespace clearway::report::detail {
namespace {

int strictness_of(const std::string& state) {
    return state == "red" ? 2 : state == "yellow" ? 1 : 0;
}

/// What the strictest of some signals shows from moment to moment, at `place_m`.
void add_strictest(const std::vector<const SignalSpan*>& spans, double place_m,
                   std::vector<SignalSpan>& bars) {
    std::vector<double> moments_s;
    for (const SignalSpan* const span : spans) {
        moments_s.push_back(span->from_s);
        moments_s.push_back(span->to_s);
    }
    std::ranges::sort(moments_s);
    const std::size_t first = bars.size();
    for (std::size_t next = 1; next < moments_s.size(); ++next) {
        const double from_s = moments_s[next - 1];
        const double to_s = moments_s[next];
        const SignalSpan* shown = nullptr;
        for (const SignalSpan* const span : spans)
            if (from_s < to_s && span->from_s <= from_s && span->to_s >= to_s &&
                (shown == nullptr || strictness_of(span->state) > strictness_of(shown->state)))
                shown = span;
        if (shown == nullptr) continue;
        if (bars.size() > first && bars.back().state == shown->state && bars.back().to_s == from_s)
            bars.back().to_s = to_s;
        else
            bars.push_back({shown->signal, shown->state, place_m, from_s, to_s});
    }
}

}  // namespace

BarPlaces::BarPlaces(std::initializer_list<const JourneyFacts*> journeys, double least_m)
    : least_m_(least_m) {
    std::vector<double> stop_lines_m;
    for (const JourneyFacts* const journey : journeys)
        for (const SignalSpan& span : journey->signals)
            stop_lines_m.push_back(span.distance_m);
    std::ranges::sort(stop_lines_m);
    for (const double stop_line_m : stop_lines_m) {
        if (places_m_.empty() || stop_line_m >= places_m_.back() + least_m)
            places_m_.push_back(stop_line_m);
        else if (stop_line_m > places_m_.back())
            are_shared_ = true;
    }
}

std::vector<SignalSpan> BarPlaces::bars_of(const JourneyFacts& journey) const {
    std::map<double, std::vector<const SignalSpan*>> at_place;
    for (const SignalSpan& span : journey.signals)
        at_place[*std::prev(std::ranges::upper_bound(places_m_, span.distance_m))].push_back(&span);
    std::vector<SignalSpan> bars;
    for (const auto& [place_m, spans] : at_place)
        add_strictest(spans, place_m, bars);
    return bars;
}

std::string BarPlaces::note() const {
    return are_shared_ ? fmt::format(
                             " Signals less than {} m behind another share its bar, which shows the "
                             "strictest of them.",
                             number(least_m_, typeset(0)))
                       : "";
}

}  // namespace clearway::report::detail
