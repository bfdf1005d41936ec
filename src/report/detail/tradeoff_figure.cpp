#include <algorithm>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

constexpr Measure gain = Measure::emergency_restricted_time;
constexpr Measure cost = Measure::other_time_loss;

/// A point with its intervals. The gain is what the difference of EV travel time is below 0.
struct Point {
    std::size_t number = 0;  ///< Of the condition in its scenario.
    const ConditionFacts* condition = nullptr;
    bool turned_alone = false;  ///< A setting of another condition: drawn small, without a number.

    MaybeEstimate gained() const {
        MaybeEstimate time = condition->difference(gain);
        if (!time) return time;
        time->mean = -time->mean;
        if (time->interval) time->interval = analysis::Interval{-time->interval->high, -time->interval->low};
        return time;
    }
    const MaybeEstimate& lost() const { return condition->difference(cost); }
};

std::vector<Point> points_of(const StudyFacts& study, const ScenarioFacts& scenario) {
    std::vector<Point> points;
    for (std::size_t number = 0; number < scenario.conditions.size(); ++number) {
        const ConditionFacts& condition = scenario.conditions[number];
        Point point{number, &condition, reference_of(study, scenario, condition) != nullptr};
        if (condition.is_compared() && point.gained() && point.lost()) points.push_back(point);
    }
    // The small ones first, so that none hides a number.
    std::stable_partition(points.begin(), points.end(),
                          [](const Point& point) { return point.turned_alone; });
    return points;
}

void draw(Plot& plot, const Point& point) {
    const MaybeEstimate gained = point.gained();
    const double x = plot.x().place(point.lost()->mean);
    const double y = plot.y().place(gained->mean);
    const std::string series = fmt::format("s{}", point.number % palette_size);
    if (point.turned_alone) {
        plot.circle(x, y, 3.0, "dot small " + series);
        return;
    }
    if (const analysis::Interval* const across = shown_interval(point.lost()))
        plot.path({{plot.x().place(across->low), y}, {plot.x().place(across->high), y}},
                  "bar thin " + series);
    if (const analysis::Interval* const up = shown_interval(gained))
        plot.path({{x, plot.y().place(up->low)}, {x, plot.y().place(up->high)}}, "bar thin " + series);
    plot.circle(x, y, 8.0, "dot " + series);
    plot.text(x, y + 4.0, std::to_string(point.number), Plot::Anchor::middle, "onDot");
}

DataTable data_of(const std::vector<Point>& points) {
    DataTable table{{"Condition", "number", "gain of EVs, s [95 %]", "cost to the others, s each [95 %]",
                     "pairs", "objection"},
                    {}};
    for (const Point& point : points) {
        const MaybeEstimate gained = point.gained();
        table.rows.push_back({point.condition->label(), std::to_string(point.number),
                              estimate(gained, typeset(2)), estimate(point.lost(), typeset(2)),
                              grouped(gained->n),
                              analysis::emergency_objection_word(point.condition->objections)});
    }
    return table;
}

std::vector<LegendEntry> entries_of(const std::vector<Point>& points) {
    std::vector<LegendEntry> entries;
    for (const Point& point : points) {
        if (point.turned_alone) continue;
        const std::string objection = analysis::emergency_objection_word(point.condition->objections);
        entries.push_back(number_entry(
            point.number, point.condition->label() + (objection.empty() ? "" : " (" + objection + ")")));
    }
    return entries;
}

}  // namespace

Figure tradeoff_figure(const StudyFacts& study, const ScenarioFacts& scenario) {
    const std::vector<Point> points = points_of(study, scenario);
    if (points.empty()) return {};
    Range costs;
    Range gains;
    costs.include(0.0);
    gains.include(0.0);
    gains.include(scenario.least_relevant_s);
    gains.include(-scenario.least_relevant_s);
    for (const Point& point : points) {
        costs.include(point.lost());
        gains.include(point.gained());
    }
    const std::string title =
        fmt::format("{}: gain of emergency vehicles and cost to the others", scenario.name);
    Chart plot(title, 330.0, padded(costs, 0.1), "others lose, s each", padded(gains, 0.1),
               "emergency vehicles gain, s a trip");
    const double top = plot.y().place(scenario.least_relevant_s);
    plot.rectangle(left_edge, top, right_edge - left_edge, plot.y().place(-scenario.least_relevant_s) - top,
                   "uncounted");
    plot.horizontal(0.0);
    plot.vertical(0.0);
    for (const Point& point : points)
        draw(plot, point);
    plot.legend(entries_of(points));
    std::string note = fmt::format(
        "Up is better for emergency vehicles, left is better for the others. Bars are 95 % intervals. In the "
        "grey band a gain or loss is below {} s and does not count.",
        number(scenario.least_relevant_s, typeset(1)));
    if (std::ranges::any_of(points, &Point::turned_alone)) note += " Small dots: one setting turned alone.";
    return {"tradeoff-" + scenario.name, "Gain and cost", plot.finish(), note, data_of(points)};
}

}  // namespace clearway::report::detail
