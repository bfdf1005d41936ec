#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::array signal_states = {"red", "yellow", "green"};

DataTable journey_data(const JourneyFacts& journey) {
    DataTable table{{"What", "from, s", "to, s", "distance, m"}, {}};
    for (const JourneyPlace& place : journey.places)
        table.rows.push_back(
            {"vehicle", number(place.time_s, typeset(1)), "", number(place.distance_m, typeset(0))});
    for (const SignalSpan& span : journey.signals)
        table.rows.push_back({fmt::format("signal {}: {}", span.signal, span.state),
                              number(span.from_s, typeset(1)), number(span.to_s, typeset(1)),
                              number(span.distance_m, typeset(0))});
    return table;
}

Figure journey_figure(const ScenarioFacts& scenario, const JourneyFacts& journey, const Series& series,
                      Range times, Range distances) {
    const std::string title = fmt::format("{}: {}", scenario.name, journey.condition);
    Chart plot(
        fmt::format("{}: time and distance of {} with the signals on its route", title, journey.vehicle),
        340.0, times, "time since departure, s", distances, "distance along the route, m");
    constexpr double bar = 6.5;  // its height with a gap
    const BarPlaces places({&journey}, bar * plot.y().value_of_unit());
    for (const SignalSpan& span : places.bars_of(journey))
        plot.stripe({span.from_s, span.to_s}, span.distance_m, ("signal-" + span.state).c_str());
    plot.line(way_of(journey), series);
    const std::string note = fmt::format(
        "Replication {}, vehicle {}. Level lines are the stop lines on its route, in the state that is "
        "shown to it.{}",
        journey.replication, journey.vehicle, places.note());
    std::vector<LegendEntry> entries = {line_entry(series, "emergency vehicle")};
    for (const char* const state : signal_states)
        if (core::contains(journey.signals, state, &SignalSpan::state))
            entries.push_back(
                stripe_entry(fmt::format("signal-{}", state).c_str(), fmt::format("signal {}", state)));
    plot.legend(entries);
    return {fmt::format("journey-{}-{}", scenario.name, journey.condition), title, plot.finish(), note,
            journey_data(journey)};
}

std::vector<Figure> journey_figures(const ScenarioFacts& scenario, const Looks& looks) {
    Range times;
    Range distances;
    for (const JourneyFacts& journey : scenario.journeys)
        include(journey, times, distances);
    if (times.empty() || times.high <= times.low || distances.high <= distances.low) return {};
    std::vector<Figure> figures;
    for (const JourneyFacts& journey : scenario.journeys) {
        const auto condition =
            std::ranges::find(scenario.conditions, journey.condition, &ConditionFacts::label);
        const auto place = static_cast<std::size_t>(condition - scenario.conditions.begin());
        const Series series = place < looks.size() ? looks[place] : Series{place};
        figures.push_back(journey_figure(scenario, journey, series, times, distances));
    }
    return figures;
}

}  // namespace

void journeys_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>The journey of one EV in one replication, under the baseline and the conditions that help "
        "most. The slope of the vehicle\u2019s line is its speed, and a level piece is a stop. One run "
        "shows how a policy works; for how much it gains see the tables.</p>\n");
    for (const ScenarioFacts& scenario : study.scenarios)
        writer.figures(journey_figures(scenario, looks_of(study, scenario)));
}

}  // namespace clearway::report::detail
