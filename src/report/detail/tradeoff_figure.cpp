#include <algorithm>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/overview_figures.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

constexpr double tradeoff_height = 330.0;
constexpr Measure gain = Measure::emergency_restricted_time;
constexpr Measure cost = Measure::other_time_loss;

/// A point with its intervals. The gain is what the difference of EV travel time is below 0.
struct Point {
    std::size_t number = 0;  ///< Of the condition in its scenario.
    const ConditionFacts* condition = nullptr;
    bool turned_alone = false;  ///< A setting of another condition: drawn small, without a number.

    const Estimate& time() const { return condition->outcome(gain).difference; }
    const Estimate& others() const { return condition->outcome(cost).difference; }
    double x() const { return *others().mean; }
    double y() const { return -*time().mean; }
};

std::vector<Point> points_of(const StudyFacts& study, const ScenarioFacts& scenario) {
    std::vector<Point> points;
    for (std::size_t number = 0; number < scenario.conditions.size(); ++number) {
        const ConditionFacts& condition = scenario.conditions[number];
        Point point{number, &condition, reference_of(study, scenario, condition) != nullptr};
        if (condition.is_compared() && point.time().mean && point.others().mean) points.push_back(point);
    }
    // The small ones first, so that none hides a number.
    std::stable_partition(points.begin(), points.end(),
                          [](const Point& point) { return point.turned_alone; });
    return points;
}

void include(const Point& point, Range& costs, Range& gains) {
    costs.include(point.x());
    gains.include(point.y());
    if (point.others().has_interval()) {
        costs.include(*point.others().low);
        costs.include(*point.others().high);
    }
    if (point.time().has_interval()) {
        gains.include(-*point.time().low);
        gains.include(-*point.time().high);
    }
}

void draw(Plot& plot, const Point& point) {
    const double x = plot.x().place(point.x());
    const double y = plot.y().place(point.y());
    const std::string series = fmt::format("s{}", point.number % palette_size);
    if (point.turned_alone) {
        plot.circle(x, y, 3.0, "dot small " + series);
        return;
    }
    if (point.others().has_interval())
        plot.path({{plot.x().place(*point.others().low), y}, {plot.x().place(*point.others().high), y}},
                  "bar thin " + series);
    if (point.time().has_interval())
        plot.path({{x, plot.y().place(-*point.time().high)}, {x, plot.y().place(-*point.time().low)}},
                  "bar thin " + series);
    plot.circle(x, y, 8.0, "dot " + series);
    plot.text(x, y + 4.0, std::to_string(point.number), Plot::Anchor::middle, "onDot");
}

DataTable data_of(const std::vector<Point>& points) {
    DataTable table{{"Condition", "number", "gain of EVs, s [95 %]", "cost to the others, s each [95 %]",
                     "pairs", "objection"},
                    {}};
    for (const Point& point : points) {
        Estimate mirrored = point.time();
        mirrored.mean = -*mirrored.mean;
        if (mirrored.low && mirrored.high) {
            mirrored.low = -*point.time().high;
            mirrored.high = -*point.time().low;
        }
        table.rows.push_back({point.condition->label(), std::to_string(point.number),
                              estimate(mirrored, typeset(2)), estimate(point.others(), typeset(2)),
                              grouped(point.time().count),
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
    for (const Point& point : points)
        include(point, costs, gains);
    const std::string title =
        fmt::format("{}: gain of emergency vehicles and cost to the others", scenario.name);
    Plot plot(title, tradeoff_height, {padded(costs, 0.1), "others lose, s each", left_edge, right_edge},
              {padded(gains, 0.1), "emergency vehicles gain, s a trip", tradeoff_height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
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
