#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

/// How a signal's state is drawn: a level line whose style differs in more than colour.
struct SignalStyle {
    const char* state;
    const char* style;
    const char* words;
};
constexpr std::array<SignalStyle, 3> signal_styles = {{{"red", "signal-red", "red"},
                                                       {"yellow", "signal-yellow", "yellow"},
                                                       {"green", "signal-green", "green"}}};

const char* style_of(const std::string& state) {
    for (const SignalStyle& style : signal_styles) {
        if (state == style.state) return style.style;
    }
    return "signal-red";
}

std::vector<LegendEntry> signal_entries() {
    std::vector<LegendEntry> entries;
    for (const SignalStyle& style : signal_styles)
        entries.push_back(stripe_entry(style.style, fmt::format("signal {}", style.words)));
    return entries;
}

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

Figure journey_figure(const ScenarioFacts& scenario, const JourneyFacts& journey, Range times,
                      Range distances) {
    constexpr double height = 340.0;
    const std::string title = fmt::format("{}: {}", scenario.name, journey.condition);
    Plot plot(
        fmt::format("{}: time and distance of {} with the signals on its route", title, journey.vehicle),
        height, {times, "time since departure, s", left_edge, right_edge},
        {distances, "distance along the route, m", height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
    for (const SignalSpan& span : journey.signals)
        plot.stripe({span.from_s, span.to_s}, span.distance_m, style_of(span.state));
    std::vector<std::pair<double, double>> points;
    for (const JourneyPlace& place : journey.places)
        points.emplace_back(place.time_s, place.distance_m);
    plot.line(points, 0);
    const std::string note = fmt::format(
        "Replication {}, vehicle {}. Level lines are the stop lines on its route, in the state that is "
        "shown to it.",
        journey.replication, journey.vehicle);
    std::vector<LegendEntry> entries = signal_entries();
    entries.insert(entries.begin(), line_entry(0, "emergency vehicle"));
    plot.legend(entries);
    return {fmt::format("journey-{}-{}", scenario.name, journey.condition), title, plot.finish(), note,
            journey_data(journey)};
}

std::vector<Figure> journey_figures(const ScenarioFacts& scenario) {
    Range times;
    Range distances;
    for (const JourneyFacts& journey : scenario.journeys) {
        for (const JourneyPlace& place : journey.places) {
            times.include(place.time_s);
            distances.include(place.distance_m);
        }
    }
    if (times.empty() || times.high <= times.low || distances.high <= distances.low) return {};
    std::vector<Figure> figures;
    for (const JourneyFacts& journey : scenario.journeys)
        figures.push_back(journey_figure(scenario, journey, times, distances));
    return figures;
}

}  // namespace

void journeys_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>The journey of one EV in one replication, under the baseline and the conditions that help "
        "most. The slope of the vehicle\u2019s line is its speed, and a level piece is a stop. One run "
        "shows how a policy works; for how much it gains see the tables.</p>\n");
    for (const ScenarioFacts& scenario : study.scenarios)
        writer.figures(journey_figures(scenario));
}

}  // namespace clearway::report::detail
