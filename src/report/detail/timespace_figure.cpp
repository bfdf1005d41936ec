#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"

namespace clearway::report::detail {
namespace {

constexpr double offset = 2.6;     // of a run's signals from the stop line, so that both runs are seen
constexpr double two_bars = 11.0;  // the height of both with a gap

const JourneyFacts* journey_under(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const auto found = std::ranges::find(scenario.journeys, condition.label(), &JourneyFacts::condition);
    return found == scenario.journeys.end() || found->places.size() < 2 ? nullptr : &*found;
}

/// What the signals showed in one run, beside their stop lines.
void draw_signals(Plot& plot, const std::vector<SignalSpan>& bars, double below) {
    for (const SignalSpan& span : bars) {
        const double y = plot.y().place(span.distance_m) + below;
        const double begin_s = std::max(span.from_s, plot.x().values.low);
        const double end_s = std::min(span.to_s, plot.x().values.high);
        if (end_s > begin_s)
            plot.path({{plot.x().place(begin_s), y}, {plot.x().place(end_s), y}}, "signal-" + span.state);
    }
}

/// Colours of signals that are there, and no others.
void add_signal_colours(const JourneyFacts& without, const JourneyFacts& with,
                        std::vector<LegendEntry>& legend) {
    for (const char* const state : {"red", "yellow", "green"}) {
        const auto shows = [&](const SignalSpan& span) { return span.state == state; };
        if (std::ranges::any_of(without.signals, shows) || std::ranges::any_of(with.signals, shows))
            legend.push_back(stripe_entry(fmt::format("signal-{}", state).c_str(), state));
    }
}

void add_data(const JourneyFacts& journey, DataTable& table) {
    for (const JourneyPlace& place : journey.places)
        table.rows.push_back({journey.condition, "vehicle", "", number(place.time_s, typeset(1)), "",
                              number(place.distance_m, typeset(0))});
    for (const SignalSpan& span : journey.signals)
        table.rows.push_back({journey.condition, "signal " + span.signal, span.state,
                              number(span.from_s, typeset(1)), number(span.to_s, typeset(1)),
                              number(span.distance_m, typeset(0))});
}

/// The journey on a stretch, from and to its ends where it goes beyond.
JourneyFacts on(const Range& stretch, const JourneyFacts& journey) {
    JourneyFacts cut = journey;
    cut.places.clear();
    const JourneyPlace* before = nullptr;
    for (const JourneyPlace& place : journey.places) {
        for (const double end_m : {stretch.low, stretch.high}) {
            if (before == nullptr || before->distance_m >= end_m || place.distance_m <= end_m) continue;
            const double share = (end_m - before->distance_m) / (place.distance_m - before->distance_m);
            cut.places.push_back({before->time_s + share * (place.time_s - before->time_s), end_m});
        }
        if (place.distance_m >= stretch.low && place.distance_m <= stretch.high) cut.places.push_back(place);
        before = &place;
    }
    return cut;
}

bool has_way(const JourneyFacts& journey) {
    const std::vector<JourneyPlace>& places = journey.places;
    return places.size() > 1 && places.back().time_s > places.front().time_s;
}

/// Where signals stand close together, the stretch around them: of the whole way their colours would lie on
/// each other. Nothing where they do not.
std::optional<Range> stretch_of_signals(const JourneyFacts& without, const JourneyFacts& with,
                                        const Range& whole) {
    constexpr double least_margin_m = 150.0;
    constexpr double worth_cutting = 0.6;  // of the whole
    Range signals;
    for (const JourneyFacts* const journey : {&without, &with})
        for (const SignalSpan& span : journey->signals)
            signals.include(span.distance_m);
    if (signals.empty()) return std::nullopt;
    const double margin_m = std::max(least_margin_m, 0.5 * (signals.high - signals.low));
    const Range stretch(std::max(whole.low, signals.low - margin_m),
                        std::min(whole.high, signals.high + margin_m));
    const bool is_worth_it = stretch.high - stretch.low < worth_cutting * (whole.high - whole.low);
    return is_worth_it ? std::optional(stretch) : std::nullopt;
}

/// The two journeys as they are drawn, and the stretch where that is not all of them.
struct DrawnTrip {
    JourneyFacts without, with;
    Range times, distances;
    std::optional<Range> stretch;
};

DrawnTrip drawn(JourneyFacts without, JourneyFacts with) {
    DrawnTrip trip{std::move(without), std::move(with), {}, {}, {}};
    include(trip.without, trip.times, trip.distances);
    include(trip.with, trip.times, trip.distances);
    const auto stretch = stretch_of_signals(trip.without, trip.with, trip.distances);
    if (!stretch) return trip;
    DrawnTrip cut{on(*stretch, trip.without), on(*stretch, trip.with), {}, {}, stretch};
    if (!has_way(cut.without) || !has_way(cut.with)) return trip;
    include(cut.without, cut.times, cut.distances);
    include(cut.with, cut.times, cut.distances);
    return cut;
}

/// ` Of 20 trips that arrived in both, 7 gain more; the median gain is 11 s.`: how a trip stands among all.
/// Empty if it did not arrive.
std::string standing_words(const std::vector<TripGain>& gains, const JourneyFacts& journey) {
    const auto own = std::ranges::find_if(gains, [&](const TripGain& one) {
        return one.replication == journey.replication && one.vehicle == journey.vehicle;
    });
    if (own == gains.end()) return {};
    std::vector<double> seconds;
    for (const TripGain& one : gains)
        seconds.push_back(one.gain_s);
    const auto more = std::ranges::count_if(seconds, [&](double gain_s) { return gain_s > own->gain_s; });
    return fmt::format(" Of all {} that arrived in both, {} gain more; the median gain is {} s.",
                       counted(gains.size(), "trip"), more, number(analysis::median(seconds), typeset(0)));
}

/// What is drawn and which trip it is.
std::string note_of(const ScenarioFacts& scenario, const ConditionFacts& condition,
                    const JourneyFacts& without, const JourneyFacts& with,
                    const std::optional<Range>& stretch) {
    const bool has_two_ways = scenario.of_map() == &condition &&
                              std::ranges::any_of(scenario.map->changed_ways, [&](const ChangedWay& change) {
                                  return is_shown_trip(scenario, change);
                              });
    const double length_m = std::max(without.places.back().distance_m, with.places.back().distance_m);
    const double saved_s = without.places.back().time_s - with.places.back().time_s;
    return fmt::format(
        "Vehicle {}, replication {}: {} s {}.{}{}{} A level piece is a stop. {} the first {}, its gain is "
        "nearest to the mean of all (and at least half of it, if that of any is).",
        with.vehicle, with.replication, number(std::abs(saved_s), typeset(0)),
        saved_s >= 0.0 ? "sooner" : "later", standing_words(condition.trip_changes.gains, with),
        has_two_ways ? " It took another way with the condition: each line follows its own." : "",
        stretch ? fmt::format(" Drawn are metres {} to {} of {}, around its signals.",
                              number(stretch->low, typeset(0)), number(stretch->high, typeset(0)),
                              number(length_m, typeset(0)))
                : "",
        without.signals.empty() && with.signals.empty()
            ? "No signal stands on its route. Of the trips of"
            : "Signals on its route are drawn twice: without the condition above the stop "
              "line, with it below; a vehicle may stand at green behind one whose turn has red. "
              "Of the trips that pass signals in",
        counted(std::min<std::uint64_t>(metrics::journeys_kept, scenario.replications), "replication"));
}

}  // namespace

void include(const JourneyFacts& journey, Range& times, Range& distances) {
    for (const JourneyPlace& place : journey.places) {
        times.include(place.time_s);
        distances.include(place.distance_m);
    }
}

Points way_of(const JourneyFacts& journey) {
    Points points;
    for (const JourneyPlace& place : journey.places)
        points.emplace_back(place.time_s, place.distance_m);
    return points;
}

Figure timespace_figure(const ScenarioFacts& scenario, const Looks& looks, const ConditionFacts& condition) {
    const ConditionFacts* const baseline = scenario.baseline_of(condition);
    if (baseline == nullptr) return {};
    const JourneyFacts* const without = journey_under(scenario, *baseline);
    const JourneyFacts* const with = journey_under(scenario, condition);
    if (without == nullptr || with == nullptr) return {};
    const DrawnTrip trip = drawn(*without, *with);
    if (trip.times.high <= trip.times.low || trip.distances.high <= trip.distances.low) return {};
    Chart plot(fmt::format("{}: one trip with and without {}", scenario.name, condition.label()), 330.0,
               trip.times, "time since departure, s", trip.distances, "distance along the route, m");
    const BarPlaces places({without, with}, two_bars * plot.y().value_of_unit());
    draw_signals(plot, places.bars_of(*without), -offset);
    draw_signals(plot, places.bars_of(*with), offset);
    const Series& baseline_series = looks[scenario.place_of(condition.baseline)];
    const Series& series = looks[scenario.place_of(condition.name())];
    plot.line(way_of(trip.without), baseline_series);
    plot.line(way_of(trip.with), series);
    const bool has_bars = !without->signals.empty() || !with->signals.empty();
    const auto named = [&](const ConditionFacts& run, const char* bars) {
        constexpr std::size_t longest = 42;  // leaves room in the legend's line
        return has_bars ? shortened(run.label(), longest) + bars : run.label();
    };
    std::vector<LegendEntry> legend = {line_entry(baseline_series, named(*baseline, ", upper bars")),
                                       line_entry(series, named(condition, ", lower bars"))};
    add_signal_colours(*without, *with, legend);
    plot.legend(legend);
    DataTable data{{"Condition", "what", "state", "from, s", "to, s", "distance, m"}, {}};
    add_data(*without, data);
    add_data(*with, data);
    return {"trip-" + scenario.name, "One trip with and without", plot.finish(),
            note_of(scenario, condition, *without, *with, trip.stretch) + places.note(), std::move(data)};
}

}  // namespace clearway::report::detail
