#include <algorithm>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/markup.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

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

/// A number only if no effect is shown: otherwise more replications are not needed.
std::string replications_needed(const ConditionFacts& condition) {
    const bool open = effect_of(condition, Measure::emergency_restricted_time) == Effect::none_shown;
    if (!condition.precision || !open) return missing(Script::typeset);
    if (condition.precision->needed > most_replications_asked)
        return fmt::format("more than {}", most_replications_asked);
    return grouped(condition.precision->needed);
}

}  // namespace

std::string slopes_figure(const ScenarioFacts& scenario) {
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
    std::vector<std::pair<std::size_t, std::string>> entries;
    for (std::size_t column = 0; column < rows.size(); ++column) {
        const ConditionFacts& condition = scenario.conditions[rows[column]];
        const double from = static_cast<double>(column) + 0.5 * (1.0 - panel);
        for (const TravelTimePair& pair : thinned(condition.travel_time_pairs))
            plot.hair({{from, pair.baseline_s}, {from + panel, pair.condition_s}}, rows[column]);
        const TravelTimePair mean = mean_of(condition.travel_time_pairs);
        plot.line({{from, mean.baseline_s}, {from + panel, mean.condition_s}}, rows[column]);
        entries.emplace_back(rows[column], condition.label());
    }
    std::string note =
        "Each thin line is one replication, from the baseline (left) to the condition (right); the "
        "thick one is the mean. Means over all EVs; one that did not arrive counts with the horizon.";
    if (most > drawn_pairs)
        note += fmt::format(" Of {} pairs about {} are drawn.", grouped(most), drawn_pairs);
    return to_html(Figure{scenario.name, plot.finish(), legend(entries), note, slopes_data(scenario)});
}

std::string precision_figure(const ScenarioFacts& scenario) {
    Range replications;
    Range widths;
    widths.include(0.0);
    widths.include(scenario.least_relevant_s);
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.precision) continue;
        for (const PrecisionPoint& point : condition.precision->points) {
            replications.include(static_cast<double>(point.replications));
            widths.include(point.half_width_s);
        }
    }
    if (replications.empty()) return {};
    constexpr double least_width = 5.0;  // so that the ticks are whole numbers
    replications.high = std::max(replications.high, replications.low + least_width);
    constexpr double height = 270.0;
    widths.high *= 1.05;
    Plot plot(fmt::format("{}: width of the interval over replications", scenario.name), height,
              {replications, "replications", left_edge, right_edge},
              {widths, "half width of the interval, s", height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
    if (scenario.least_relevant_s > 0.0) plot.horizontal(scenario.least_relevant_s);
    std::vector<std::pair<std::size_t, std::string>> entries;
    DataTable data{{"Condition, replications", "half width, s"}, {}};
    for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
        const ConditionFacts& condition = scenario.conditions[row];
        if (!condition.precision || condition.precision->points.empty()) continue;
        std::vector<std::pair<double, double>> points;
        for (const PrecisionPoint& point : condition.precision->points) {
            points.emplace_back(static_cast<double>(point.replications), point.half_width_s);
            data.rows.push_back({fmt::format("{}, {}", condition.label(), point.replications),
                                 number(point.half_width_s, typeset(2))});
        }
        plot.line(points, row);
        entries.emplace_back(row, condition.label());
    }
    const std::string note = fmt::format("The level line is the smallest difference that counts, {} s.",
                                         number(scenario.least_relevant_s, typeset(1)));
    return to_html(Figure{scenario.name, plot.finish(), legend(entries), note, std::move(data)});
}

DataTable precision_table(const ScenarioFacts& scenario) {
    const double wanted_s =
        scenario.least_relevant_s > 0.0 ? scenario.least_relevant_s : usual_least_relevant_s;
    DataTable table{
        {"Condition", "complete pairs", "deviation of the differences, s", "half width, s",
         fmt::format("replications for \u00b1{} s, where no effect is shown", number(wanted_s, typeset(1)))},
        {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        const Estimate& difference = condition.outcome(Measure::emergency_restricted_time).difference;
        const auto& precision = condition.precision;
        table.rows.push_back(
            {condition.label(), grouped(difference.count),
             precision ? number(precision->deviation_s, typeset(1)) : missing(Script::typeset),
             difference.has_interval() ? number((*difference.high - *difference.low) / 2.0, typeset(2))
                                       : missing(Script::typeset),
             replications_needed(condition)});
    }
    return table;
}

}  // namespace clearway::report::detail
