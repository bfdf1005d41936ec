#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/markup.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::size_t drawn_approaches = 8;  // those with the largest changes; the data list more
constexpr double cost_left = 26.0;           // leaves room for half a label of three digits
constexpr double cost_right = 250.0;         // the numbers are to the right of the drawing
constexpr double cost_row_height = 34.0;
constexpr std::size_t listed_approaches = 100;

std::string name_of(const ApproachFacts& approach) {
    return approach.street.empty() ? approach.edge : fmt::format("{} ({})", approach.street, approach.edge);
}

/// The start of a long name, cut between characters, so that the label stays within its figure.
std::string shortened(const std::string& name) {
    constexpr std::size_t longest = 52;
    if (name.size() <= longest) return name;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U)
        --end;
    return name.substr(0, end) + "\u2026";
}

std::string signed_number(const std::optional<double>& value, int decimals) {
    return value ? number(*value, typeset(decimals, Sign::always)) : missing(Script::typeset);
}

DataTable approach_data(const ConditionFacts& condition) {
    DataTable table{{"Approach", "time lost, s per run [95 %]", "human-driven", "automated", "waiting time",
                     "baseline, s per run", "vehicles per run", "per vehicle, s"},
                    {}};
    for (const ApproachFacts& approach : condition.approaches) {
        if (table.rows.size() == listed_approaches) break;
        const NumberStyle style = typeset(0, Sign::always);
        table.rows.push_back({name_of(approach), estimate(approach.difference, style),
                              estimate(approach.human, style), estimate(approach.automated, style),
                              estimate(approach.waiting, style),
                              approach.baseline_s ? number(*approach.baseline_s, typeset(0)) : "",
                              approach.vehicles ? number(*approach.vehicles, typeset(1)) : "",
                              signed_number(approach.per_vehicle_s, 2)});
    }
    return table;
}

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

std::string signal_legend() {
    std::string html = "<ul class=\"legend\">" + fmt::format("<li>{}emergency vehicle</li>", swatch(1));
    for (const SignalStyle& style : signal_styles) {
        html += fmt::format(
            "<li><svg class=\"swatch\" viewBox=\"0 0 28 10\" aria-hidden=\"true\"><path class=\"{}\" "
            "d=\"M1 5H27\"/></svg>signal {}</li>",
            style.style, style.words);
    }
    return html + "</ul>\n";
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

std::string journey_figure(const ScenarioFacts& scenario, const JourneyFacts& journey, Range times,
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
    plot.line(points, 1);
    const std::string note = fmt::format(
        "Replication {}, vehicle {}. Level lines are the stop lines on its route, in the state that is "
        "shown to it.",
        journey.replication, journey.vehicle);
    return to_html(Figure{title, plot.finish(), signal_legend(), note, journey_data(journey)});
}

}  // namespace

std::string approach_figure(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    const std::size_t shown = std::min(condition.approaches.size(), drawn_approaches);
    if (shown == 0) return {};
    Range range;
    range.include(0.0);
    for (std::size_t row = 0; row < shown; ++row) {
        const Estimate& difference = condition.approaches[row].difference;
        if (difference.mean) range.include(*difference.mean);
        if (!difference.has_interval()) continue;
        range.include(*difference.low);
        range.include(*difference.high);
    }
    const double height = static_cast<double>(shown) * cost_row_height + 12.0 + label_space;
    const std::string title = fmt::format("{}: {}", scenario.name, condition.label());
    Plot plot(fmt::format("{}: time lost by approach against the baseline", title), height,
              {padded(range, 0.06), "time lost against the baseline, s per run", cost_left, cost_right},
              {{}, "", 6.0, height - label_space});
    plot.grid_x();
    plot.vertical(0.0);
    double top = 6.0;
    for (std::size_t row = 0; row < shown; ++row, top += cost_row_height) {
        const ApproachFacts& approach = condition.approaches[row];
        const Estimate& difference = approach.difference;
        plot.text(10.0, top + 11.0, shortened(name_of(approach)), Plot::Anchor::start, "label");
        plot.text(right_edge, top + 26.0, estimate(difference, typeset(0, Sign::always)), Plot::Anchor::end,
                  "value");
        if (difference.has_interval()) {
            plot.interval({*difference.low, *difference.high}, *difference.mean, top + 22.0, 1);
        } else if (difference.mean) {
            plot.point(*difference.mean, top + 22.0, 1);
        }
    }
    std::string note = "Time lost on the approach per run, summed over all vehicles that are not EVs.";
    if (condition.approaches.size() > shown)
        note += fmt::format(" Shown are the {} of {} approaches with the largest changes.", shown,
                            condition.approaches.size());
    return to_html(Figure{title, plot.finish(), "", note, approach_data(condition)});
}

std::string recovery_figure(const ScenarioFacts& scenario) {
    Range offsets;
    Range halted;
    halted.include(0.0);
    for (const ConditionFacts& condition : scenario.conditions) {
        for (const RecoveryFacts& point : condition.recovery) {
            offsets.include(point.offset_s);
            halted.include(point.halted.mean.value_or(0.0));
        }
    }
    if (offsets.empty() || offsets.high <= offsets.low) return {};
    constexpr double height = 270.0;
    Plot plot(
        fmt::format("{}: halted vehicles on the other approaches after an EV", scenario.name), height,
        {offsets, "time after the EV passed, s", left_edge, right_edge},
        {padded(halted, 0.08), "more halted vehicles than in the baseline", height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
    plot.horizontal(0.0);
    plot.vertical(0.0);
    std::vector<std::pair<std::size_t, std::string>> entries;
    DataTable data{{"Condition, s after the EV", "more halted vehicles [95 %]"}, {}};
    for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
        const ConditionFacts& condition = scenario.conditions[row];
        if (condition.recovery.empty()) continue;
        std::vector<std::pair<double, double>> points;
        for (const RecoveryFacts& point : condition.recovery) {
            points.emplace_back(point.offset_s, point.halted.mean.value_or(0.0));
            data.rows.push_back({fmt::format("{}, {}", condition.label(), number(point.offset_s, typeset(0))),
                                 estimate(point.halted, typeset(2, Sign::always))});
        }
        plot.line(points, row);
        entries.emplace_back(row,
                             fmt::format("{}: {}", condition.label(),
                                         condition.recovered_after_s
                                             ? fmt::format("recovered after {} s",
                                                           number(*condition.recovered_after_s, typeset(0)))
                                             : "not recovered in this time"));
    }
    return to_html(
        Figure{scenario.name, plot.finish(), legend(entries),
               "Halted vehicles on the signal's other approaches around each passage of an EV, compared "
               "with the passages of the baseline. Recovered: from then on no interval lies above 0 for 30 "
               "s.",
               std::move(data)});
}

std::string journey_figures(const ScenarioFacts& scenario) {
    Range times;
    Range distances;
    for (const JourneyFacts& journey : scenario.journeys) {
        for (const JourneyPlace& place : journey.places) {
            times.include(place.time_s);
            distances.include(place.distance_m);
        }
    }
    if (times.empty() || times.high <= times.low || distances.high <= distances.low) return {};
    std::string html;
    for (const JourneyFacts& journey : scenario.journeys)
        html += journey_figure(scenario, journey, times, distances);
    return html;
}

}  // namespace clearway::report::detail
