#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

Points steps(const Distribution& distribution, double last) {
    Points points;
    double share = 0.0;
    for (const SharePoint& point : distribution.points) {
        if (point.seconds > last) break;
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
        const Distribution& distribution = condition.distribution;
        std::vector<std::string> row = {condition.label(), grouped(distribution.all),
                                        grouped(distribution.arrived)};
        for (const double share : {0.10, 0.25, 0.50, 0.75, 0.90, 0.95}) {
            row.push_back(seconds_at(distribution, share));
        }
        row.push_back(estimate(condition.travel_time.median, typeset(1)));
        row.push_back(estimate(condition.travel_time.percentile_95, typeset(1)));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::string distribution_note(const ScenarioFacts& scenario) {
    std::string note =
        "Share of all EVs of the demand, so a curve that ends below 1 shows EVs that did not arrive. "
        "Replications are pooled; the intervals under Data come from resampling whole replications.";
    note += fmt::format(" There is no 95th percentile of fewer than {} trips.",
                        analysis::TravelTimeTail::fewest_trips);
    const bool thinned = std::any_of(
        scenario.conditions.begin(), scenario.conditions.end(),
        [](const auto& one) { return one.distribution.arrived > one.distribution.points.size(); });
    if (thinned) {
        note += fmt::format(" Drawn at {} ranks, evenly spaced; the steps between them are left out.",
                            distribution_points);
    }
    return note;
}

constexpr std::size_t drawn_pairs = 60;  // per condition; more lines merge into a grey area

/// EV travel times of one replication, s: restricted means over all EVs.
struct Pair {
    double baseline_s = 0.0;
    double condition_s = 0.0;
};

/// Complete pairs, in the order of the replications.
std::vector<Pair> pairs_of(const ConditionFacts& condition) {
    std::vector<Pair> pairs;
    const auto& comparison = condition.outcome(Measure::emergency_restricted_time).comparison;
    if (!comparison) return pairs;
    for (std::size_t pair = 0; pair < comparison->baseline_values.size(); ++pair)
        pairs.push_back({comparison->baseline_values[pair], comparison->condition_values[pair]});
    return pairs;
}

/// Evenly spaced pairs, at most `drawn_pairs`.
std::vector<Pair> thinned(const std::vector<Pair>& pairs) {
    const std::size_t stride = (pairs.size() + drawn_pairs - 1) / drawn_pairs;
    std::vector<Pair> shown;
    for (std::size_t pair = 0; pair < pairs.size(); pair += stride)
        shown.push_back(pairs[pair]);
    return shown;
}

Pair mean_pair(const std::vector<Pair>& pairs) {
    Pair sum;
    for (const Pair& pair : pairs) {
        sum.baseline_s += pair.baseline_s;
        sum.condition_s += pair.condition_s;
    }
    const auto n = static_cast<double>(pairs.size());
    return {sum.baseline_s / n, sum.condition_s / n};
}

DataTable slopes_data(const ScenarioFacts& scenario) {
    DataTable table{{"Condition, pair", labelled(primary, "baseline"), labelled(primary, "condition"),
                     labelled(primary, "difference")},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        std::size_t place = 0;
        for (const Pair& pair : thinned(pairs_of(condition))) {
            table.rows.push_back({fmt::format("{}, {}", condition.label(), ++place),
                                  number(pair.baseline_s, typeset(1)), number(pair.condition_s, typeset(1)),
                                  number(pair.condition_s - pair.baseline_s, typeset(1, Sign::always))});
        }
    }
    return table;
}

/// The axis of times: to the longest, or, where few trips would take much of it, to the greatest 95th
/// percentile of a condition, with what lies beyond.
Axis time_axis(const ScenarioFacts& scenario) {
    constexpr double drawn_share = 0.95;
    constexpr double worth_cutting = 0.8;  // of the whole
    Range all;
    Range shown;
    for (const ConditionFacts& condition : scenario.conditions) {
        const Distribution& distribution = condition.distribution;
        if (distribution.points.empty()) continue;
        for (const SharePoint& point : distribution.points)
            all.include(point.seconds);
        shown.include(distribution.points.front().seconds);
        const auto last = std::ranges::lower_bound(
            distribution.points, drawn_share * distribution.points.back().share, {}, &SharePoint::share);
        shown.include(last->seconds);
    }
    if (all.empty() || shown.high - all.low >= worth_cutting * (all.high - all.low))
        return {all.empty() ? all : padded(all, 0.04), "EV travel time, s"};
    shown = padded(shown, 0.04);
    double beyond = 0.0;
    for (const ConditionFacts& condition : scenario.conditions) {
        const Distribution& distribution = condition.distribution;
        if (distribution.points.empty()) continue;
        const auto first =
            std::ranges::upper_bound(distribution.points, shown.high, {}, &SharePoint::seconds);
        const double share = first == distribution.points.begin() ? 0.0 : std::prev(first)->share;
        beyond += (distribution.points.back().share - share) * static_cast<double>(distribution.all);
    }
    return {shown, fmt::format("EV travel time ({} beyond, up to {} s), s",
                               counted(static_cast<std::uint64_t>(std::lround(beyond)), "trip"),
                               number(all.high, typeset(0)))};
}

Figure distribution_figure(const ScenarioFacts& scenario, const Looks& looks) {
    const Axis times = time_axis(scenario);
    if (times.values.empty()) return {};
    std::vector<std::size_t> all(scenario.conditions.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto draw = [&](Plot& plot, std::size_t place, std::size_t /*slot*/, const Series& series) {
        const Distribution& distribution = scenario.conditions[place].distribution;
        if (!distribution.points.empty()) plot.line(steps(distribution, plot.x().values.high), series);
    };
    return {"travel-time-" + scenario.name, scenario.name,
            line_figure({fmt::format("{}: distribution of EV travel time", scenario.name),
                         300.0,
                         times,
                         {Range(0.0, 1.0), "share of EVs that arrived within, 0 to 1"}},
                        scenario, looks, all, draw),
            distribution_note(scenario), distribution_data(scenario)};
}

void draw_slopes(Plot& plot, const std::vector<Pair>& pairs, std::size_t slot, const Series& series) {
    constexpr double share = 0.62;  // of the slot; the rest keeps neighbours apart
    const double from = static_cast<double>(slot) + 0.5 * (1.0 - share);
    for (const Pair& pair : thinned(pairs))
        plot.hair({{from, pair.baseline_s}, {from + share, pair.condition_s}}, series);
    const Pair mean = mean_pair(pairs);
    plot.joined({{from, mean.baseline_s}, {from + share, mean.condition_s}}, series);
}

Figure slopes_figure(const ScenarioFacts& scenario, const Looks& looks) {
    Range seconds;
    std::size_t most = 0;
    std::vector<std::size_t> drawn;
    for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
        const std::vector<Pair> pairs = pairs_of(scenario.conditions[row]);
        if (pairs.empty()) continue;
        most = std::max(most, pairs.size());
        for (const Pair& pair : thinned(pairs)) {
            seconds.include(pair.baseline_s);
            seconds.include(pair.condition_s);
        }
        drawn.push_back(row);
    }
    if (drawn.empty()) return {};
    std::string note =
        "Each thin line is one replication, from the baseline (left) to the condition (right); the "
        "thick one is the mean. Means over all EVs; one that did not arrive counts with the horizon.";
    if (most > drawn_pairs)
        note += fmt::format(" Of {} pairs about {} are drawn.", grouped(most), drawn_pairs);
    return {"pairs-" + scenario.name, scenario.name,
            line_figure(
                {fmt::format("{}: EV travel time of each replication, baseline and condition", scenario.name),
                 328.0,
                 {{}, "each from the baseline (left) to a condition (right)", 0.0, 0.0, Scale::slots},
                 {padded(seconds, 0.04), labelled(primary)}},
                scenario, looks, drawn,
                [&](Plot& plot, std::size_t place, std::size_t slot, const Series& series) {
                    draw_slopes(plot, pairs_of(scenario.conditions[place]), slot, series);
                }),
            note, slopes_data(scenario)};
}

DataTable response_data(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "90th percentile, s [95 %]", "against the baseline, s [95 %]",
                     fmt::format("within {:g} s, % [95 %]", scenario.response_threshold_s),
                     "against the baseline, points [95 %]"},
                    {}};
    constexpr double percent = 100.0;
    for (const ConditionFacts& condition : scenario.conditions) {
        const analysis::ResponseTime& response = condition.response;
        const NumberStyle with_sign = typeset(1, Sign::always);
        const auto difference = [&](const MaybeEstimate& value, double factor) {
            return condition.is_compared() ? estimate(value, with_sign, factor) : std::string();
        };
        table.rows.push_back({condition.label(), estimate(response.percentile_90_s, typeset(1)),
                              difference(response.percentile_90_difference_s, 1.0),
                              estimate(response.in_time, typeset(1), percent),
                              difference(response.in_time_difference, percent)});
    }
    return table;
}

void response_tables(const StudyFacts& study, Writer& writer) {
    const auto has_trips = [](const ScenarioFacts& scenario) { return scenario.response_threshold_s > 0.0; };
    if (std::none_of(study.scenarios.begin(), study.scenarios.end(), has_trips)) return;
    writer.heading("Response time");
    writer.markup(fmt::format(
        "<p>As dispatchers count: the time that nine in ten EVs do not exceed, and the share of EVs that "
        "are in time. An EV that did not arrive counts with the horizon and is late; of fewer than {} trips "
        "there is no such time. Unless a threshold was given, it is 100 s per km of the mean EV route, the "
        "pace of the 240 s of NFPA 1710 over 1.5 miles. Intervals come from resampling whole replications; "
        "differences are paired.</p>\n",
        analysis::ResponseTime::fewest_trips));
    for (const ScenarioFacts& scenario : study.scenarios) {
        if (has_trips(scenario))
            writer.table(
                {"response-" + scenario.name, scenario.name + ": response time", response_data(scenario)});
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
