#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "report/detail/canvas.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// A range of values. `low` < `high` after `padded`.
struct Range {
    double low = 0.0;
    double high = 0.0;

    Range() = default;
    Range(double from, double to) : low(from), high(to), seen_(true) {}

    void include(double value);
    /// The mean, and the interval where it is printed.
    void include(const MaybeEstimate& estimate);
    /// The same with an interval of however few values.
    void include_all(const MaybeEstimate& estimate);
    bool empty() const { return !seen_; }

  private:
    bool seen_ = false;
};

/// Marks of an axis: multiples of 1, 2 or 5 times a power of ten (Heckbert, "Nice Numbers for Graph Labels",
/// Graphics Gems, 1990, without his loose labelling) that lie within a range.
struct Ticks {
    std::vector<double> values;
    int decimals = 0;  ///< Enough to tell neighbouring values apart.
};
/// At least `least_step` apart.
Ticks nice_ticks(Range range, int wanted, double least_step = 0.0);
/// Powers of ten within 10^exponents, at most seven.
Ticks decade_ticks(Range exponents);

/// The range with a margin on both sides, wide enough to be drawn when all of its values are equal.
Range padded(Range range, double share);

/// How an axis spaces its values: evenly, evenly with marks at whole numbers alone, evenly without marks as
/// they count what stands beside each other, or with the same width for each decade.
enum class Scale { linear, whole, slots, logarithmic };

/// An axis of a figure: what it shows and where.
struct Axis {
    Range values;  ///< Decimal logarithms of the values where the scale is logarithmic.
    std::string label;
    double from = 0.0;  ///< Place of `values.low` in the figure's units.
    double to = 0.0;    ///< Place of `values.high`.
    Scale scale = Scale::linear;

    /// On a logarithmic axis values below its range, 0 included, are placed at its low end.
    double place(double value) const {
        const double at = scale != Scale::logarithmic ? value
                          : value > 0.0               ? std::max(values.low, std::log10(value))
                                                      : values.low;
        return from + (at - values.low) / (values.high - values.low) * (to - from);
    }
    /// How much of an even axis a unit of the figure is.
    double value_of_unit() const { return (values.high - values.low) / std::abs(to - from); }
};

inline constexpr double right_edge = 388.0;  ///< Of the drawing area; the rest keeps the last label inside.
inline constexpr double left_edge = 52.0;    ///< Room for the labels of y.
inline constexpr double top_edge = 26.0;     ///< Room for the label of y.
inline constexpr double label_space = 44.0;  ///< Below the drawing area.

using Points = std::vector<std::pair<double, double>>;

/// A drawing with two axes.
class Plot : public Canvas {
  public:
    /// `height` includes the labels of the axes.
    Plot(const std::string& title, double height, Axis x, Axis y);

    const Axis& x() const { return x_; }
    const Axis& y() const { return y_; }

    void grid_x();
    void grid_y();
    /// A polyline in the style of `series`, with its marks.
    void line(const Points& points, const Series& series);
    /// The same with marks at its points alone.
    void joined(const Points& points, const Series& series);
    /// A horizontal interval with its mean, at height `y` in figure units.
    void interval(std::pair<double, double> bounds, double mean, double y, const Series& series);
    void point(double value, double y, const Series& series);
    /// The two above: a point if there is no interval to draw, and nothing without an estimate.
    void estimate(const MaybeEstimate& value, const analysis::Interval* interval, double y,
                  const Series& series);
    /// A filled bar between two values of x, at height `y` in figure units.
    void beam(std::pair<double, double> bounds, double y, const Series& series);
    /// A horizontal line between two values of x at a value of y, with the CSS class `style`.
    void stripe(std::pair<double, double> bounds, double value, const char* style);
    void vertical(double value);
    /// Hides what was drawn between two heights, in figure units, so that a line of text is not crossed.
    void blank(double top, double bottom);
    /// A vertical interval at `x`.
    void whisker(double x, std::pair<double, double> bounds, const Series& series);
    /// A horizontal line across the figure at a value of y.
    void horizontal(double value);
    /// A thin polyline, for figures with many lines.
    void hair(const Points& points, const Series& series);
    /// The area between two bounds of y over x: (x, low, high).
    void band(const std::vector<std::array<double, 3>>& bounds, const Series& series);
    /// Continues with other axes: the next panel of the drawing.
    void turn_to(Axis x, Axis y);

  private:
    void polyline(const std::string& style, const Points& points);
    void marks(const Points& points, const Series& series);

    Axis x_;
    Axis y_;
};

/// A plot over the whole drawing area, with the lines of both axes.
struct Chart : Plot {
    Chart(const std::string& title, double height, const Range& x, const std::string& x_label, const Range& y,
          const std::string& y_label)
        : Chart(title, height, {x, x_label}, {y, y_label}) {}
    /// Places of the axes are set here.
    Chart(const std::string& title, double height, Axis x, Axis y);
};

/// What small multiples have in common: their title, what their axes measure, and a legend if they need one.
struct PanelWords {
    std::string title;
    std::string label;   ///< Of y.
    std::string across;  ///< Of x.
    std::vector<LegendEntry> legend = {};
};
/// Small multiples: panels of one scale, two beside each other in one drawing. `draw` is called with the plot
/// turned to each panel, and its number. Labels of the axes are not drawn.
std::string panels(const PanelWords& words, std::size_t count, const Axis& x, const Axis& y,
                   const std::function<void(Plot&, std::size_t)>& draw);

}  // namespace clearway::report::detail
