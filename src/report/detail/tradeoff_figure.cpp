#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

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
    Series series = {};         ///< Its number is `number`.

    MaybeEstimate gained() const {
        MaybeEstimate time = condition->difference(gain);
        if (!time) return time;
        time->mean = -time->mean;
        if (time->interval) time->interval = analysis::Interval{-time->interval->high, -time->interval->low};
        return time;
    }
    const MaybeEstimate& lost() const { return condition->difference(cost); }
    std::string objection() const { return analysis::emergency_objection_word(condition->objections); }
};

double mean_or_zero(const MaybeEstimate& estimate) {
    return analysis::mean_of(estimate).value_or(0.0);
}

/// Whether each of its runs is one of another condition whose mark stands at the same place: with other
/// opponents, equal runs gain differently.
bool is_shown_by_another(const ScenarioFacts& scenario, const Point& point) {
    const std::size_t same = scenario.place_of(point.condition->same_as);
    if (point.series.weight == Series::Weight::lead || same >= scenario.conditions.size()) return false;
    const ConditionFacts& other = scenario.conditions[same];
    const auto equal = [&](Measure measure) {
        return mean_or_zero(other.difference(measure)) == mean_or_zero(point.condition->difference(measure));
    };
    return other.is_compared() && equal(gain) && equal(cost);
}

/// In the order in which they are drawn.
std::vector<Point> points_of(const StudyFacts& study, const ScenarioFacts& scenario) {
    std::vector<Point> points;
    const Looks looks = looks_of(study, scenario);
    for (const std::size_t number : drawing_order(looks)) {
        const ConditionFacts& condition = scenario.conditions[number];
        Point point{number, &condition, reference_of(study, scenario, condition) != nullptr, looks[number]};
        if (condition.is_compared() && point.gained() && point.lost()) points.push_back(point);
    }
    // The small ones first, so that none hides a number.
    std::stable_partition(points.begin(), points.end(),
                          [](const Point& point) { return point.turned_alone; });
    return points;
}

using Place = std::pair<double, double>;
constexpr double badge_radius = 8.0;
constexpr double mark_radius = 5.5;
constexpr const char* see_through = " through";  ///< A mark that others may lie on.
constexpr const char* hollow = " hollow";        ///< The mark of a condition that loses or hits more EVs.

/// The dash tells colours apart without colour.
std::string interval_style(const Series& series) {
    return series.levels ? fmt::format("{} d{}", colour_of(series), series.levels->colour)
                         : colour_of(series);
}

double distance(const Place& a, const Place& b) {
    return std::hypot(a.first - b.first, a.second - b.second);
}

/// Where the number or mark of a point stands: at the point, or as near as is free of those in `taken`.
Place free_place(const Place& point, const std::vector<Place>& taken, double radius, const Plot& plot) {
    const double apart = 2.0 * radius + 1.5;
    constexpr int directions = 16;
    const auto is_free = [&](const Place& place) {
        const auto [x, y] = place;
        return x > left_edge + radius && x < right_edge - radius && y > plot.y().to + radius &&
               y < plot.y().from - radius && std::ranges::none_of(taken, [&](const Place& other) {
                   return distance(place, other) < apart;
               });
    };
    for (double away = 0.0; away <= 6.0 * apart; away += 0.5 * apart) {
        for (int step = 0; step < directions; ++step) {
            const double angle = 2.0 * std::numbers::pi * step / directions;
            const Place place{point.first + away * std::cos(angle), point.second + away * std::sin(angle)};
            if (is_free(place)) return place;
        }
    }
    return point;
}

void draw_intervals(Plot& plot, const Point& point, const Place& place) {
    const std::string style = "bar thin " + interval_style(point.series);
    const auto [x, y] = place;
    if (const analysis::Interval* const across = shown_interval(point.lost()))
        plot.path({{plot.x().place(across->low), y}, {plot.x().place(across->high), y}}, style);
    const MaybeEstimate gained = point.gained();
    if (const analysis::Interval* const up = shown_interval(gained))
        plot.path({{x, plot.y().place(up->low)}, {x, plot.y().place(up->high)}}, style);
}

void draw_leader(Plot& plot, const Point& point, const Place& place, const Place& at) {
    if (at == place) return;
    const std::string colour = colour_of(point.series);
    plot.circle(place.first, place.second, 2.6, "dot " + colour);
    plot.path({place, at}, "leader " + colour);
}

void draw_number(Plot& plot, const Point& point, const Place& at) {
    const std::string colour = colour_of(point.series);
    if (point.series.weight == Series::Weight::lead)
        plot.circle(at.first, at.second, badge_radius + 2.5, "ring " + colour);
    plot.circle(at.first, at.second, badge_radius, "dot " + colour);
    plot.text(at.first, at.second + 4.0, std::to_string(point.number), Plot::Anchor::middle, "onDot");
}

void draw_mark(Plot& plot, const Point& point, const Place& at) {
    if (point.series.weight == Series::Weight::lead)
        plot.circle(at.first, at.second, mark_radius + 4.0, "ring " + colour_of(point.series));
    plot.add(mark_of(point.series, at.first, at.second, mark_radius,
                     point.objection().empty() ? see_through : hollow));
}

std::vector<Place> places_of(const Plot& plot, const std::vector<Point>& points) {
    std::vector<Place> places;
    for (const Point& point : points)
        places.emplace_back(plot.x().place(point.lost()->mean), plot.y().place(point.gained()->mean));
    return places;
}

/// Intervals first. Then marks at the places of points, or numbers, none of which hides another, with dots
/// and what leads to them. Returns whether some numbers do not stand at their points.
bool draw(Plot& plot, const std::vector<Point>& points, const std::vector<Place>& places) {
    for (std::size_t at = 0; at < points.size(); ++at) {
        if (points[at].turned_alone)
            plot.circle(places[at].first, places[at].second, 3.0,
                        "dot small " + colour_of(points[at].series));
        else
            draw_intervals(plot, points[at], places[at]);
    }
    if (points.front().series.levels) {
        for (std::size_t at = 0; at < points.size(); ++at)
            draw_mark(plot, points[at], places[at]);
        return false;
    }
    std::vector<Place> taken;
    bool is_moved = false;
    for (std::size_t at = points.size(); at-- > 0;) {  // The one that leads is placed first: at its point.
        if (points[at].turned_alone) continue;
        taken.push_back(free_place(places[at], taken, badge_radius, plot));
        is_moved = is_moved || taken.back() != places[at];
        draw_leader(plot, points[at], places[at], taken.back());
    }
    for (const Point& point : points) {
        if (point.turned_alone) continue;
        draw_number(plot, point, taken.back());
        taken.pop_back();
    }
    return is_moved;
}

/// ` 8 marks touch others; the data have each.`, where marks are left at their values.
std::string touching_words(const std::vector<Point>& points, const std::vector<Place>& places) {
    if (!points.front().series.levels) return "";
    const auto touching = std::ranges::count_if(places, [&](const Place& place) {
        return 1 < std::ranges::count_if(
                       places, [&](const Place& other) { return distance(place, other) < mark_radius; });
    });
    return touching == 0 ? "" : fmt::format(" {} marks touch others; the data have each.", touching);
}

std::vector<Point> by_number(std::vector<Point> points) {
    std::ranges::sort(points, {}, &Point::number);
    return points;
}

DataTable data_of(const std::vector<Point>& points) {
    DataTable table{{"Condition", "number", labelled(gain, "gain") + " [95 %]",
                     labelled(cost, "difference") + " [95 %]", "pairs", "objection"},
                    {}};
    for (const Point& point : by_number(points)) {
        const MaybeEstimate gained = point.gained();
        table.rows.push_back({point.condition->label(), std::to_string(point.number),
                              estimate(gained, typeset(2)), estimate(point.lost(), typeset(2)),
                              grouped(gained->n), point.objection()});
    }
    return table;
}

std::vector<LegendEntry> entries_of(const std::vector<Point>& points) {
    std::vector<LegendEntry> entries;
    for (const Point& point : by_number(points)) {
        if (point.turned_alone) continue;
        const std::string objection = point.objection();
        entries.push_back(number_entry(
            point.series, point.condition->label() + (objection.empty() ? "" : " (" + objection + ")")));
    }
    return entries;
}

/// What the ring and the grey band mean.
std::vector<LegendEntry> sign_entries(const ScenarioFacts& scenario, const std::vector<Point>& points) {
    std::vector<LegendEntry> entries;
    for (const Point& point : points) {
        if (point.series.weight == Series::Weight::lead)
            entries.push_back(dot_entry("ring " + colour_of(point.series),
                                        "ring, of the headline: " + point.condition->label()));
    }
    if (scenario.least_relevant_s > 0.0)
        entries.push_back(
            {"<rect class=\"uncounted\" x=\"6\" y=\"0\" width=\"22\" height=\"10\"/>",
             fmt::format("grey: below {} s, does not count", number(scenario.least_relevant_s, typeset(1)))});
    entries.push_back({"<path class=\"bar thin s0\" d=\"M6 5H28M17 0V10\"/>", "95 % intervals"});
    return entries;
}

/// `policy: ...` in colours, `failure: ...` in marks, and what hollow marks mean.
void add_legends(Plot& plot, const Crossing& crossing, const std::vector<Point>& points) {
    const auto named = [&](const Crossing::Aspect& aspect, std::size_t Series::Levels::*level_of,
                           const auto& entry_of) {
        std::vector<std::string> names;
        for (const std::string& name : aspect.names)
            names.push_back(name.substr(name.rfind('.') + 1));
        std::vector<LegendEntry> entries = {{"", fmt::format("{}:", fmt::join(names, ", "))}};
        for (std::size_t level = 1; level <= aspect.levels.size(); ++level) {
            const bool is_drawn = std::ranges::any_of(points, [&](const Point& point) {
                return point.series.levels && *point.series.levels.*level_of == level;
            });
            if (is_drawn) entries.push_back(entry_of(level, aspect.levels[level - 1]));
        }
        return entries;
    };
    plot.legend(
        named(crossing.colour, &Series::Levels::colour, [](std::size_t level, const std::string& words) {
            return line_entry({.levels = Series::Levels{level, 0}}, words);
        }));
    plot.legend(named(crossing.mark, &Series::Levels::mark, [](std::size_t level, const std::string& words) {
        return mark_entry({.levels = Series::Levels{0, level}}, words);
    }));
    std::set<std::string> objections;
    for (const Point& point : points) {
        if (!point.objection().empty()) objections.insert(point.objection());
    }
    if (!objections.empty())
        plot.legend({mark_entry({.levels = Series::Levels{0, 1}},
                                fmt::format("hollow: {}", fmt::join(objections, " or ")), hollow)});
}

}  // namespace

Figure tradeoff_figure(const StudyFacts& study, const ScenarioFacts& scenario) {
    std::vector<Point> points = points_of(study, scenario);
    if (points.empty()) return {};
    DataTable data = data_of(points);
    std::vector<std::string> merged;
    std::erase_if(points, [&](const Point& point) {
        const bool is_merged = is_shown_by_another(scenario, point);
        if (is_merged)
            merged.push_back(
                fmt::format("{} = {}", point.condition->label(),
                            scenario.conditions[scenario.place_of(point.condition->same_as)].label()));
        return is_merged;
    });
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
    Chart plot(title, 330.0, padded(costs, 0.1), labelled(cost, "difference (left is better)"),
               padded(gains, 0.1), labelled(gain, "gain over the baseline (up is better)"));
    const double top = plot.y().place(scenario.least_relevant_s);
    plot.rectangle(left_edge, top, right_edge - left_edge, plot.y().place(-scenario.least_relevant_s) - top,
                   "uncounted");
    plot.horizontal(0.0);
    plot.vertical(0.0);
    const std::vector<Place> places = places_of(plot, points);
    const bool is_moved = draw(plot, points, places);
    const std::optional<Crossing> crossing = crossing_of(study, scenario);
    if (crossing)
        add_legends(plot, *crossing, points);
    else
        plot.legend(entries_of(points));
    std::vector<LegendEntry> signs = sign_entries(scenario, points);
    if (is_moved)
        signs.push_back(
            {"<circle class=\"dot s0\" cx=\"8\" cy=\"5\" r=\"2.6\"/><path class=\"leader s0\" d=\"M8 "
             "5H28\"/>",
             "dot: the true place of the number at its line"});
    plot.legend(signs);
    if (!merged.empty()) {
        constexpr std::size_t letters = 56;  // of a legend's line
        for (const std::string& line :
             lines_of(fmt::format("equal runs, one mark: {}", fmt::join(merged, "; ")), letters))
            plot.legend({{"", line}});
    }
    std::string note = fmt::format(
        "Up is better for emergency vehicles, left is better for the others. Bars are 95 % intervals. In the "
        "grey band a gain or loss is below {} s and does not count.",
        number(scenario.least_relevant_s, typeset(1)));
    note += touching_words(points, places);
    if (is_moved) note += " A number that would hide another has a line to its dot.";
    if (!merged.empty())
        note += fmt::format(" Of equal runs one mark is drawn: {}.", fmt::join(merged, "; "));
    if (std::ranges::any_of(points, &Point::turned_alone)) note += " Small dots: one setting turned alone.";
    return {"tradeoff-" + scenario.name, "Gain and cost against the baseline", plot.finish(), note,
            std::move(data)};
}

}  // namespace clearway::report::detail
