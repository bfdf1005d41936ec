#include "report/detail/grid.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/terminal.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double heading_height = 20.0;
constexpr double columns_height = 18.0;
constexpr double line_height = 13.0;
constexpr double row_height = 24.0;
constexpr double below_height = 12.0;  ///< More for a second line.
constexpr double small_letter = 5.1;   ///< Width of one of that line.
constexpr double cells_right = 396.0;
constexpr double gap = 2.0;
constexpr double label_margin = 7.0;
constexpr double letter = 6.5;  ///< Width of one.
/// Letters of a row's label: at least the first, and up to the second where columns leave room.
constexpr double short_label = 18.0;
constexpr double longest_label = 40.0;
constexpr double usual_column = 60.0;
constexpr std::size_t most_columns = 6;  ///< More are too narrow for their figures.

}  // namespace

std::string style_of(GridCell::Tone tone) {
    switch (tone) {
        case GridCell::Tone::better:
            return "cell better";
        case GridCell::Tone::worse:
            return "cell worse";
        case GridCell::Tone::neutral:
            return "cell";
        case GridCell::Tone::empty:
            break;
    }
    return "cell empty";
}

const char* alone_mark(const MaybeEstimate& difference, const std::optional<double>& holm_p) {
    const analysis::Interval* const interval = shown_interval(difference);
    const bool is_clear = interval != nullptr && !interval->contains(0.0);
    return is_clear && holm_p && *holm_p > 1.0 - analysis::usual_level ? shown_alone : "";
}

const char* alone_mark(const ConditionFacts& condition, Measure measure) {
    const auto& comparison = condition.outcome(measure).comparison;
    return comparison ? alone_mark(comparison->difference, comparison->holm_p) : "";
}

namespace {

/// Letters of a column's heading in one line; one is left free between neighbours.
std::size_t letters_in(double width) {
    return static_cast<std::size_t>(std::max(width / letter - 1.0, 1.0));
}

/// A heading that is too long for one line goes on in a second behind its last separator that fits.
std::vector<std::string> heading_lines(const std::string& heading, std::size_t letters) {
    if (core::characters_in(heading) <= letters) return {heading};
    const std::size_t end = heading.find_last_of("_ +.,:-", letters - 1);
    if (end == std::string::npos || end + 1 == heading.size()) return {shortened(heading, letters - 1)};
    const std::string rest = heading.substr(end + 1);
    const bool fits = core::characters_in(rest) <= letters;
    return {heading.substr(0, end + 1), fits ? rest : shortened(rest, letters - 1)};
}

/// Letters of the longest second line of a cell; 0 without any.
std::size_t letters_below(const Grid& grid) {
    std::size_t letters = 0;
    for (const Grid::Row& row : grid.rows)
        for (const GridCell& cell : row.cells)
            letters = std::max(letters, core::characters_in(cell.below));
    return letters;
}

/// Letters of the longest label that is drawn whole.
std::size_t label_letters(const Grid& grid) {
    const double second_line = small_letter * static_cast<double>(letters_below(grid)) + 2.0 * gap;
    const double columns = static_cast<double>(std::min(grid.columns.size(), most_columns));
    const double room = cells_right - columns * std::max(usual_column, second_line) - label_margin;
    return static_cast<std::size_t>(std::clamp(room / letter, short_label, longest_label));
}

/// Room for the labels of the rows.
double cells_left_of(const Grid& grid) {
    const std::size_t most = label_letters(grid);
    std::size_t letters = 4;
    for (const Grid::Row& row : grid.rows)
        letters = std::max(letters, std::min(core::characters_in(row.label), most));
    return label_margin + letter * static_cast<double>(letters);
}

double column_width(const Grid& grid) {
    return (cells_right - cells_left_of(grid)) / static_cast<double>(grid.columns.size());
}

/// Room for the headings of the columns.
double columns_height_of(const Grid& grid) {
    const std::size_t letters = letters_in(column_width(grid));
    const bool is_long = std::ranges::any_of(
        grid.columns, [&](const std::string& column) { return heading_lines(column, letters).size() > 1; });
    return columns_height + (is_long ? line_height : 0.0);
}

double row_height_of(const Grid& grid) {
    return row_height + (letters_below(grid) > 0 ? below_height : 0.0);
}

/// Units that a grid takes from its top.
double grid_height(const Grid& grid) {
    return (grid.heading.empty() ? 0.0 : heading_height) + columns_height_of(grid) +
           row_height_of(grid) * static_cast<double>(grid.rows.size()) + 8.0;
}

/// Draws a grid with its upper edge at `top`.
void draw_grid(const Grid& grid, double top, Canvas& canvas) {
    using Anchor = Canvas::Anchor;
    if (!grid.heading.empty()) {
        canvas.text(2.0, top + 14.0, shortened(grid.heading, 60), Anchor::start, "heading");
        top += heading_height;
    }
    const double cells_left = cells_left_of(grid);
    const double width = column_width(grid);
    for (std::size_t column = 0; column < grid.columns.size(); ++column) {
        double bottom = top + columns_height_of(grid) - 6.0;
        const std::vector<std::string> lines = heading_lines(grid.columns[column], letters_in(width));
        for (auto line = lines.rbegin(); line != lines.rend(); ++line, bottom -= line_height)
            canvas.text(cells_left + (static_cast<double>(column) + 0.5) * width - gap / 2.0, bottom, *line,
                        Anchor::middle, "tick");
    }
    top += columns_height_of(grid);
    const double height = row_height_of(grid);
    const std::size_t letters = label_letters(grid);
    for (const Grid::Row& row : grid.rows) {
        canvas.text(2.0, top + 16.0, shortened(row.label, letters), Anchor::start, "label");
        for (std::size_t column = 0; column < row.cells.size(); ++column) {
            const double left = cells_left + static_cast<double>(column) * width;
            const GridCell& cell = row.cells[column];
            const double middle = left + (width - gap) / 2.0;
            canvas.rectangle(left, top, width - gap, height - gap, style_of(cell.tone));
            canvas.text(middle, top + 15.5, cell.text, Anchor::middle, "celltext");
            if (!cell.below.empty()) canvas.text(middle, top + 28.0, cell.below, Anchor::middle, "range");
        }
        top += height;
    }
}

template <class Cell>
std::vector<Cell> part_of(const std::vector<Cell>& cells, std::size_t first, std::size_t count) {
    const auto start = cells.begin() + static_cast<std::ptrdiff_t>(first);
    return {start, start + static_cast<std::ptrdiff_t>(std::min(count, cells.size() - first))};
}

/// Adds the grid as several that are narrow enough, about equally wide.
void split(const Grid& grid, std::vector<Grid>& parts) {
    const std::size_t columns = grid.columns.size();
    std::size_t most = most_columns;
    if (const std::size_t letters = letters_below(grid); letters > 0) {
        const double wanted = small_letter * static_cast<double>(letters) + 2.0 * gap;
        most = std::clamp<std::size_t>(static_cast<std::size_t>((cells_right - cells_left_of(grid)) / wanted),
                                       1, most_columns);
    }
    const std::size_t count = (columns + most - 1) / most;
    const std::size_t each = count == 0 ? 1 : (columns + count - 1) / count;
    for (std::size_t first = 0; first < columns; first += each) {
        Grid& part = parts.emplace_back(Grid{grid.heading, part_of(grid.columns, first, each), {}});
        for (const Grid::Row& row : grid.rows)
            part.rows.push_back({row.label, part_of(row.cells, first, each)});
    }
}

}  // namespace

bool has_mark(const std::vector<Grid>& grids, std::string_view mark) {
    return std::ranges::any_of(grids, [&](const Grid& grid) {
        return std::ranges::any_of(grid.rows, [&](const Grid::Row& row) {
            return std::ranges::any_of(row.cells,
                                       [&](const GridCell& cell) { return cell.text.ends_with(mark); });
        });
    });
}

std::vector<LegendEntry> tone_entries(const std::vector<Grid>& grids) {
    const auto sample = [](GridCell::Tone tone, const char* words) {
        return LegendEntry{
            fmt::format("<rect class=\"{}\" x=\"6\" y=\"0\" width=\"22\" height=\"11\"/>", style_of(tone)),
            words};
    };
    std::vector<LegendEntry> entries = {sample(GridCell::Tone::better, "better"),
                                        sample(GridCell::Tone::worse, "worse"),
                                        sample(GridCell::Tone::neutral, "no effect shown or too small")};
    if (has_mark(grids, shown_alone)) entries.push_back({"", shown_alone_words});
    return entries;
}

Canvas draw_grids(const std::string& title, const std::vector<Grid>& wide,
                  const std::vector<std::string>& axes) {
    std::vector<Grid> grids;
    for (const Grid& grid : wide)
        split(grid, grids);
    constexpr double axes_line = 16.0;
    double top = axes.empty() ? 0.0 : 8.0 + axes_line * static_cast<double>(axes.size());
    double height = top;
    for (const Grid& grid : grids)
        height += grid_height(grid);
    Canvas canvas(title, height);
    for (std::size_t line = 0; line < axes.size(); ++line)
        canvas.text(2.0, 14.0 + axes_line * static_cast<double>(line), shortened(axes[line], 62),
                    Canvas::Anchor::start, "axis");
    for (const Grid& grid : grids) {
        draw_grid(grid, top, canvas);
        top += grid_height(grid);
    }
    return canvas;
}

}  // namespace clearway::report::detail
