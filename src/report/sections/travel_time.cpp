#include <algorithm>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

std::vector<std::pair<double, double>> steps(const Distribution& distribution, double last) {
    std::vector<std::pair<double, double>> points;
    double share = 0.0;
    for (const SharePoint& point : distribution.points) {
        points.emplace_back(point.seconds, share);
        points.emplace_back(point.seconds, point.share);
        share = point.share;
    }
    points.emplace_back(last, share);
    return points;
}

/// Seconds within which `share` of all EVs arrived; a dash if fewer did.
std::string seconds_at(const Distribution& distribution, double share) {
    for (const SharePoint& point : distribution.points) {
        if (point.share >= share - 1e-9) return number(point.seconds, typeset(1));
    }
    return missing(Script::typeset);
}

DataTable distribution_data(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "EVs", "arrived", "10 % within, s", "25 %", "50 %", "75 %", "90 %", "95 %",
                     "median [95 %], s", "95th percentile [95 %], s"},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        const Distribution& distribution = condition.travel_time;
        std::vector<std::string> row = {condition.label(), grouped(distribution.all),
                                        grouped(distribution.arrived)};
        for (const double share : {0.10, 0.25, 0.50, 0.75, 0.90, 0.95}) {
            row.push_back(seconds_at(distribution, share));
        }
        row.push_back(estimate(condition.travel_time_median, typeset(1)));
        row.push_back(estimate(condition.travel_time_percentile_95, typeset(1)));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::string distribution_note(const ScenarioFacts& scenario) {
    std::string note =
        "Share of all EVs of the demand, so a curve that ends below 1 shows EVs that did not arrive. "
        "Replications are pooled; the intervals under Data come from resampling whole replications.";
    const bool thinned =
        std::any_of(scenario.conditions.begin(), scenario.conditions.end(),
                    [](const auto& one) { return one.travel_time.arrived > one.travel_time.points.size(); });
    if (thinned) {
        note += fmt::format(" Drawn at {} ranks, evenly spaced; the steps between them are left out.",
                            distribution_points);
    }
    return note;
}

constexpr std::size_t drawn_pairs = 60;  // per condition; more lines merge into a grey area

/// Evenly spaced pairs, at most `drawn_pairs`.
std::vector<TravelTimePair> thinned(const std::vector<TravelTimePair>& pairs) {
    const std::size_t stride = (pairs.size() + drawn_pairs - 1) / drawn_pairs;
    std::vector<TravelTimePair> shown;
    for (std::size_t pair = 0; pair < pairs.size(); pair += stride)
        shown.push_back(pairs[pair]);
    return shown;
}

TravelTimePair mean_of(const std::vector<TravelTimePair>& pairs) {
    TravelTimePair sum;
    for (const TravelTimePair& pair : pairs) {
        sum.baseline_s += pair.baseline_s;
        sum.condition_s += pair.condition_s;
    }
    const auto n = static_cast<double>(pairs.size());
    return {sum.baseline_s / n, sum.condition_s / n};
}

/// Conditions that have pairs, with their place in the scenario.
std::vector<std::size_t> paired_conditions(const ScenarioFacts& scenario) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
        if (!scenario.conditions[row].travel_time_pairs.empty()) rows.push_back(row);
    }
    return rows;
}

DataTable slopes_data(const ScenarioFacts& scenario) {
    DataTable table{{"Condition, pair", "baseline, s", "condition, s", "difference, s"}, {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        std::size_t place = 0;
        for (const TravelTimePair& pair : thinned(condition.travel_time_pairs)) {
            table.rows.push_back({fmt::format("{}, {}", condition.label(), ++place),
                                  number(pair.baseline_s, typeset(1)), number(pair.condition_s, typeset(1)),
                                  number(pair.condition_s - pair.baseline_s, typeset(1, Sign::always))});
        }
    }
    return table;
}

Figure distribution_figure(const ScenarioFacts& scenario) {
    Range range;
    for (const ConditionFacts& condition : scenario.conditions) {
        for (const SharePoint& point : condition.travel_time.points) {
            range.include(point.seconds);
        }
    }
    if (range.empty()) return {};
    const double height = 300.0;
    Range shares;
    shares.include(0.0);
    shares.include(1.0);
    Plot plot(fmt::format("{}: distribution of EV travel time", scenario.name), height,
              {padded(range, 0.04), "EV travel time, s", left_edge, right_edge},
              {shares, "share of EVs that arrived within", height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
    std::vector<LegendEntry> entries;
    for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
        const ConditionFacts& condition = scenario.conditions[row];
        entries.push_back(line_entry(row, condition.label()));
        if (!condition.travel_time.points.empty()) {
            plot.line(steps(condition.travel_time, plot.x().values.high), row);
        }
    }
    plot.legend(entries);
    return {"travel-time-" + scenario.name, scenario.name, plot.finish(), distribution_note(scenario),
            distribution_data(scenario)};
}

Figure slopes_figure(const ScenarioFacts& scenario) {
    const std::vector<std::size_t> rows = paired_conditions(scenario);
    if (rows.empty()) return {};
    Range seconds;
    std::size_t most = 0;
    for (const std::size_t row : rows) {
        const auto& pairs = scenario.conditions[row].travel_time_pairs;
        most = std::max(most, pairs.size());
        for (const TravelTimePair& pair : thinned(pairs)) {
            seconds.include(pair.baseline_s);
            seconds.include(pair.condition_s);
        }
    }
    constexpr double height = 300.0;
    constexpr double panel = 0.62;  // of a condition's share of the width; the rest keeps panels apart
    Range panels;
    panels.include(0.0);
    panels.include(static_cast<double>(rows.size()));
    Plot plot(fmt::format("{}: EV travel time of each replication, baseline and condition", scenario.name),
              height, {panels, "", left_edge, right_edge},
              {padded(seconds, 0.04), "EV travel time, s: baseline to condition", height - 16.0, 26.0});
    plot.grid_y();
    std::vector<LegendEntry> entries;
    for (std::size_t column = 0; column < rows.size(); ++column) {
        const ConditionFacts& condition = scenario.conditions[rows[column]];
        const double from = static_cast<double>(column) + 0.5 * (1.0 - panel);
        for (const TravelTimePair& pair : thinned(condition.travel_time_pairs))
            plot.hair({{from, pair.baseline_s}, {from + panel, pair.condition_s}}, rows[column]);
        const TravelTimePair mean = mean_of(condition.travel_time_pairs);
        plot.line({{from, mean.baseline_s}, {from + panel, mean.condition_s}}, rows[column]);
        entries.push_back(line_entry(rows[column], condition.label()));
    }
    std::string note =
        "Each thin line is one replication, from the baseline (left) to the condition (right); the "
        "thick one is the mean. Means over all EVs; one that did not arrive counts with the horizon.";
    if (most > drawn_pairs)
        note += fmt::format(" Of {} pairs about {} are drawn.", grouped(most), drawn_pairs);
    plot.legend(entries);
    return {"pairs-" + scenario.name, scenario.name, plot.finish(), note, slopes_data(scenario)};
}

DataTable response_data(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "90th percentile, s [95 %]", "against the baseline, s [95 %]",
                     fmt::format("within {:g} s, % [95 %]", scenario.response_threshold_s),
                     "against the baseline, points [95 %]"},
                    {}};
    constexpr double percent = 100.0;
    for (const ConditionFacts& condition : scenario.conditions) {
        const auto difference = [&](const Outcome& outcome, double factor) {
            return condition.is_compared() ? estimate(outcome.difference, typeset(1, Sign::always), factor)
                                           : std::string();
        };
        table.rows.push_back({condition.label(), estimate(condition.response_percentile_90.value, typeset(1)),
                              difference(condition.response_percentile_90, 1.0),
                              estimate(condition.response_in_time.value, typeset(1), percent),
                              difference(condition.response_in_time, percent)});
    }
    return table;
}

void response_tables(const StudyFacts& study, Writer& writer) {
    const auto has_trips = [](const ScenarioFacts& scenario) { return scenario.response_threshold_s > 0.0; };
    if (std::none_of(study.scenarios.begin(), study.scenarios.end(), has_trips)) return;
    writer.heading("Response time");
    writer.markup(
        "<p>As dispatchers count: the time that nine in ten EVs do not exceed, and the share of EVs that "
        "are in time. An EV that did not arrive counts with the horizon and is late. Unless a threshold was "
        "given, it is 100 s per km of the mean EV route, the pace of the 240 s of NFPA 1710 over 1.5 miles. "
        "Intervals come from resampling whole replications; differences are paired.</p>\n");
    for (const ScenarioFacts& scenario : study.scenarios) {
        if (has_trips(scenario))
            writer.table({"response-" + scenario.name, scenario.name, response_data(scenario)});
    }
}

}  // namespace

void travel_time_section(const StudyFacts& study, Writer& writer) {
    writer.figures(figures_of(study, distribution_figure));
    writer.heading("Pair by pair");
    writer.figures(figures_of(study, slopes_figure));
    response_tables(study, writer);
}

}  // namespace clearway::report::detail
