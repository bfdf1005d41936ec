#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace clearway::report::detail {

/// How a line or a point looks. Number 0 is the baseline's: solid, without marks, in the colour of the text;
/// no other number looks so. The next 20 differ in dash and mark, also without colour; the first 60 in
/// colour, dash and mark; those after them repeat the 60.
struct Series {
    std::size_t number = 0;
    enum class Weight { usual, lead } weight = Weight::usual;  ///< One line leads: the headline's condition.
    /// Where they are set, these and not the number give the looks: colour and dash one thing, the mark
    /// another. From 1 to `most_levels`; 0 is the colour of the text, and no mark.
    struct Levels {
        std::size_t colour = 0;
        std::size_t mark = 0;
    };
    std::optional<Levels> levels = {};
    static constexpr std::size_t most_levels = 6;
};

/// The start of a long text, cut between characters, with an ellipsis.
std::string shortened(const std::string& text, std::size_t longest);

/// The words of a text in lines of at most so many letters; a longer word has a line of its own.
std::vector<std::string> lines_of(const std::string& text, std::size_t letters);

/// An entry of a legend: its mark, as markup in a box of `width` x 10 units, and what it stands for.
/// Without a mark it is a heading.
struct LegendEntry {
    std::string mark;
    std::string words;
    Series::Weight weight = Series::Weight::usual;
    double width = 28.0;
};
/// CSS class of the colour of a series.
std::string colour_of(const Series& series);
/// CSS classes of the colour, dash and weight of a line.
std::string line_style(const Series& series);
/// The mark of a series around a place, as markup; empty for number 0. `more` are further CSS classes.
std::string mark_of(const Series& series, double x, double y, double radius, const std::string& more = "");

/// A piece of line in the style of `series`, its mark at the beginning: the dash stays to be seen.
LegendEntry line_entry(const Series& series, std::string words);
/// The mark of a series alone.
LegendEntry mark_entry(const Series& series, std::string words, const std::string& more = "");
/// A piece of line with the CSS class `style`.
LegendEntry stripe_entry(const char* style, std::string words);
/// A small circle with the CSS class `style`.
LegendEntry dot_entry(const std::string& style, std::string words);
/// A dot in the style of `series` that holds its number.
LegendEntry number_entry(const Series& series, std::string words);

/// A drawing of the report: an `<svg>` element. All drawings share one width, set of styles and legend. Text
/// has the size of the page's small text when 400 units are 400 px, and is still legible at 320 px. All text
/// is escaped here. Places are in figure units, from the upper left corner.
class Canvas {
  public:
    static constexpr double width = 400.0;
    enum class Anchor { start, middle, end };

    /// `title` names the figure for screen readers.
    Canvas(std::string title, double height);

    void text(double x, double y, const std::string& words, Anchor anchor, const char* style);
    void rectangle(double x, double y, double box_width, double box_height, const std::string& style);
    /// An open line through points, with CSS classes.
    void path(const std::vector<std::pair<double, double>>& points, const std::string& style);
    void circle(double x, double y, double radius, const std::string& style);
    /// Markup of `<svg>`, which is not escaped.
    void add(const std::string& markup) { svg_ += markup; }
    /// Entries below the drawing, in as many rows as they need.
    void legend(const std::vector<LegendEntry>& entries);
    /// The finished `<svg>` element.
    std::string finish();

  protected:
    std::back_insert_iterator<std::string> out() { return std::back_inserter(svg_); }

  private:
    std::string title_;
    double height_;
    std::string svg_;
};

}  // namespace clearway::report::detail
