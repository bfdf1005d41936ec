#include "report/detail/axes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "report/text.hpp"

namespace clearway::report::detail {

void Range::include(double value) {
    if (!std::isfinite(value)) return;
    low = seen_ ? std::min(low, value) : value;
    high = seen_ ? std::max(high, value) : value;
    seen_ = true;
}

void Range::include(const MaybeEstimate& estimate) {
    if (shown_interval(estimate) != nullptr)
        include_all(estimate);
    else if (estimate)
        include(estimate->mean);
}

void Range::include_all(const MaybeEstimate& estimate) {
    if (!estimate) return;
    include(estimate->mean);
    if (!estimate->interval) return;
    include(estimate->interval->low);
    include(estimate->interval->high);
}

Ticks nice_ticks(Range range, int wanted, double least_step) {
    const double rough = std::max(least_step, (range.high - range.low) / std::max(1, wanted));
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double fraction = rough / power;
    const double step = (fraction <= 1.0   ? 1.0
                         : fraction <= 2.0 ? 2.0
                         : fraction <= 5.0 ? 5.0
                                           : 10.0) *
                        power;
    Ticks ticks;
    ticks.decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    const double first = std::ceil(range.low / step - 1e-9);
    const double last = std::floor(range.high / step + 1e-9);
    for (double multiple = first; multiple <= last; ++multiple) {
        ticks.values.push_back(multiple * step);
    }
    return ticks;
}

Ticks decade_ticks(Range exponents) {
    Ticks ticks;
    const double stride = std::ceil((exponents.high - exponents.low) / 6.0);
    for (double power = std::ceil(exponents.low); power <= exponents.high; power += stride) {
        ticks.values.push_back(std::pow(10.0, power));
    }
    return ticks;
}

Range padded(Range range, double share) {
    double margin = (range.high - range.low) * share;
    if (range.high <= range.low) margin = std::max(1.0, std::abs(range.high) * 0.1);
    range.low -= margin;
    range.high += margin;
    return range;
}

Plot::Plot(const std::string& title, double height, Axis x, Axis y)
    : Canvas(title, height), x_(std::move(x)), y_(std::move(y)) {}

void Plot::turn_to(Axis x, Axis y) {
    x_ = std::move(x);
    y_ = std::move(y);
}

void Plot::grid_x() {
    Ticks ticks;
    if (x_.scale != Scale::slots) ticks = nice_ticks(x_.values, 5, x_.scale == Scale::whole ? 1.0 : 0.0);
    const double bottom = std::max(y_.from, y_.to);
    const double top = std::min(y_.from, y_.to);
    for (const double value : ticks.values) {
        fmt::format_to(out(), "<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", x_.place(value), bottom,
                       top);
        text(x_.place(value), bottom + 16.0, number(value, {ticks.decimals, Script::typeset}), Anchor::middle,
             "tick");
    }
    if (x_.label.empty()) return;
    const bool has_ticks = !ticks.values.empty();
    text((x_.from + x_.to) / 2.0, bottom + (has_ticks ? 34.0 : 22.0), x_.label, Anchor::middle,
         has_ticks ? "axis" : "tick");
}

void Plot::grid_y() {
    const bool decades = y_.scale == Scale::logarithmic;
    const Ticks ticks = decades ? decade_ticks(y_.values) : nice_ticks(y_.values, 5);
    for (const double value : ticks.values) {
        fmt::format_to(out(), "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", x_.from, y_.place(value),
                       x_.to);
        const std::string label =
            decades ? fmt::format("{:g}", value) : number(value, {ticks.decimals, Script::typeset});
        text(x_.from - 6.0, y_.place(value) + 4.0, label, Anchor::end, "tick");
    }
    if (!y_.label.empty()) text(2.0, std::min(y_.from, y_.to) - 10.0, y_.label, Anchor::start, "axis");
}

void Plot::line(const Points& points, const Series& series) {
    polyline(line_style(series), points);
    marks(points, series);
}

void Plot::joined(const Points& points, const Series& series) {
    polyline(line_style(series), points);
    for (const auto& [x, y] : points)
        add(mark_of(series, x_.place(x), y_.place(y), 3.6));
}

void Plot::hair(const Points& points, const Series& series) {
    polyline("hair " + colour_of(series), points);
}

void Plot::band(const std::vector<std::array<double, 3>>& bounds, const Series& series) {
    const auto svg = out();
    fmt::format_to(svg, "<polygon class=\"band {}\" points=\"", colour_of(series));
    for (const auto& [x, low, high] : bounds)
        fmt::format_to(svg, "{:.1f},{:.1f} ", x_.place(x), y_.place(high));
    for (std::size_t at = bounds.size(); at > 0; --at) {
        const auto& [x, low, high] = bounds[at - 1];
        fmt::format_to(svg, "{:.1f},{:.1f} ", x_.place(x), y_.place(low));
    }
    fmt::format_to(svg, "\"/>\n");
}

void Plot::polyline(const std::string& style, const Points& points) {
    const auto svg = out();
    fmt::format_to(svg, "<polyline class=\"{}\" points=\"", style);
    for (const auto& [x, y] : points) {
        fmt::format_to(svg, "{:.1f},{:.1f} ", x_.place(x), y_.place(y));
    }
    fmt::format_to(svg, "\"/>\n");
}

void Plot::marks(const Points& points, const Series& series) {
    constexpr double apart = 66.0;
    constexpr double shift =
        23.0;  // from one series to the next, so that lines on each other show both marks
    if (points.size() < 2) return;
    double length = 0.0;
    const auto from = [&](std::size_t at) {
        return std::hypot(x_.place(points[at].first) - x_.place(points[at - 1].first),
                          y_.place(points[at].second) - y_.place(points[at - 1].second));
    };
    for (std::size_t at = 1; at < points.size(); ++at)
        length += from(at);
    double next = std::min(0.5 * length, 8.0 + std::fmod(shift * static_cast<double>(series.number), apart));
    double passed = 0.0;
    for (std::size_t at = 1; at < points.size(); ++at) {
        const double piece = from(at);
        for (; piece > 0.0 && next <= passed + piece; next += apart) {
            const double share = (next - passed) / piece;
            const auto between = [&](double a, double b) { return a + share * (b - a); };
            add(mark_of(series, between(x_.place(points[at - 1].first), x_.place(points[at].first)),
                        between(y_.place(points[at - 1].second), y_.place(points[at].second)), 3.6));
        }
        passed += piece;
    }
}

void Plot::interval(std::pair<double, double> bounds, double mean, double y, const Series& series) {
    fmt::format_to(out(), "<path class=\"bar {0}\" d=\"M{1:.1f} {2:.1f}v8m0 -4H{3:.1f}m0 -4v8\"/>",
                   colour_of(series), x_.place(bounds.first), y - 4.0, x_.place(bounds.second));
    point(mean, y, series);
}

void Plot::point(double value, double y, const Series& series) {
    add(mark_of(series, x_.place(value), y, 4.5) + "\n");
}

void Plot::estimate(const MaybeEstimate& value, const analysis::Interval* interval, double y,
                    const Series& series) {
    if (interval != nullptr)
        this->interval({interval->low, interval->high}, value->mean, y, series);
    else if (value)
        point(value->mean, y, series);
}

void Plot::beam(std::pair<double, double> bounds, double y, const Series& series) {
    constexpr double half_height = 5.0;
    const auto [low, high] = std::minmax({x_.place(bounds.first), x_.place(bounds.second)});
    fmt::format_to(out(),
                   "<rect class=\"beam {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                   colour_of(series), low, y - half_height, high - low, 2.0 * half_height);
}

void Plot::stripe(std::pair<double, double> bounds, double value, const char* style) {
    fmt::format_to(out(), "<path class=\"{}\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", style, x_.place(bounds.first),
                   y_.place(value), x_.place(bounds.second));
}

void Plot::vertical(double value) {
    fmt::format_to(out(), "<path class=\"zero\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x_.place(value), y_.from,
                   y_.to);
}

void Plot::blank(double top, double bottom) {
    fmt::format_to(out(), "<rect class=\"blank\" x=\"0\" y=\"{:.1f}\" width=\"{:.0f}\" height=\"{:.1f}\"/>\n",
                   top, width, bottom - top);
}

void Plot::horizontal(double value) {
    fmt::format_to(out(), "<path class=\"zero\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", x_.from, y_.place(value),
                   x_.to);
}

void Plot::whisker(double x, std::pair<double, double> bounds, const Series& series) {
    fmt::format_to(out(), "<path class=\"bar {}\" d=\"M{:.1f} {:.1f}h6m-3 0V{:.1f}m-3 0h6\"/>\n",
                   colour_of(series), x_.place(x) - 3.0, y_.place(bounds.first), y_.place(bounds.second));
}

Chart::Chart(const std::string& title, double height, Axis x, Axis y)
    : Plot(title, height, {x.values, x.label, left_edge, right_edge, x.scale},
           {y.values, y.label, height - label_space, top_edge, y.scale}) {
    grid_x();
    grid_y();
}

std::string panels(const PanelWords& words, std::size_t count, const Axis& x, const Axis& y,
                   const std::function<void(Plot&, std::size_t)>& draw) {
    constexpr std::size_t columns = 2;
    constexpr double panel_width = 150.0;
    constexpr double panel_height = 104.0;
    constexpr double first_top = 62.0;   // room for the labels and the first titles
    constexpr double below = 168.0;      // from one panel's top to the next one's
    constexpr double first_left = 44.0;  // room for the labels of y
    constexpr double beside = 194.0;     // from one panel's left edge to the next one's
    const double rows = std::ceil(static_cast<double>(count) / columns);
    Plot plot(words.title, first_top + rows * below, {}, {});
    plot.text(2.0, 14.0, words.label, Plot::Anchor::start, "axis");
    plot.text(2.0, 30.0, "across: " + words.across, Plot::Anchor::start, "axis");
    for (std::size_t panel = 0; panel < count; ++panel) {
        const double left = first_left + beside * static_cast<double>(panel % columns);
        const std::size_t row = panel / columns;
        const double top = first_top + below * static_cast<double>(row);
        plot.turn_to({x.values, "", left, left + panel_width, x.scale},
                     {y.values, "", top + panel_height, top, y.scale});
        plot.grid_x();
        plot.grid_y();
        draw(plot, panel);
    }
    plot.legend(words.legend);
    return plot.finish();
}

}  // namespace clearway::report::detail
