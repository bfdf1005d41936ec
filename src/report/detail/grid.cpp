#include "report/detail/grid.hpp"

#include <algorithm>

#include "core/terminal.hpp"

namespace clearway::report::detail {
namespace {

constexpr double heading_height = 20.0;
constexpr double columns_height = 18.0;
constexpr double line_height = 13.0;
constexpr double row_height = 24.0;
constexpr double cells_right = 396.0;
constexpr double gap = 2.0;
constexpr double letter = 6.5;  ///< Width of one.
constexpr std::size_t longest_label = 18;

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

/// Letters of a column's heading in one line; one is left free between neighbours.
std::size_t letters_in(double width) {
    return static_cast<std::size_t>(std::max(width / letter - 1.0, 1.0));
}

/// A heading that is too long for one line goes on in a second behind its last separator that fits.
std::vector<std::string> lines_of(const std::string& heading, std::size_t letters) {
    if (core::characters_in(heading) <= letters) return {heading};
    const std::size_t end = heading.find_last_of("_ +.,:-", letters - 1);
    if (end == std::string::npos || end + 1 == heading.size()) return {shortened(heading, letters - 1)};
    const std::string rest = heading.substr(end + 1);
    const bool fits = core::characters_in(rest) <= letters;
    return {heading.substr(0, end + 1), fits ? rest : shortened(rest, letters - 1)};
}

/// Room for the labels of the rows.
double cells_left_of(const Grid& grid) {
    std::size_t letters = 4;
    for (const Grid::Row& row : grid.rows)
        letters = std::max(letters, std::min(row.label.size(), longest_label));
    return 7.0 + letter * static_cast<double>(letters);
}

double column_width(const Grid& grid) {
    return (cells_right - cells_left_of(grid)) / static_cast<double>(grid.columns.size());
}

/// Room for the headings of the columns.
double columns_height_of(const Grid& grid) {
    const std::size_t letters = letters_in(column_width(grid));
    const bool is_long = std::ranges::any_of(
        grid.columns, [&](const std::string& column) { return lines_of(column, letters).size() > 1; });
    return columns_height + (is_long ? line_height : 0.0);
}

/// Units that a grid takes from its top.
double grid_height(const Grid& grid) {
    return (grid.heading.empty() ? 0.0 : heading_height) + columns_height_of(grid) +
           row_height * static_cast<double>(grid.rows.size()) + 8.0;
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
        const std::vector<std::string> lines = lines_of(grid.columns[column], letters_in(width));
        for (auto line = lines.rbegin(); line != lines.rend(); ++line, bottom -= line_height)
            canvas.text(cells_left + (static_cast<double>(column) + 0.5) * width - gap / 2.0, bottom, *line,
                        Anchor::middle, "tick");
    }
    top += columns_height_of(grid);
    for (const Grid::Row& row : grid.rows) {
        canvas.text(2.0, top + 16.0, shortened(row.label, longest_label), Anchor::start, "label");
        for (std::size_t column = 0; column < row.cells.size(); ++column) {
            const double left = cells_left + static_cast<double>(column) * width;
            canvas.rectangle(left, top, width - gap, row_height - gap, style_of(row.cells[column].tone));
            canvas.text(left + (width - gap) / 2.0, top + 15.5, row.cells[column].text, Anchor::middle,
                        "celltext");
        }
        top += row_height;
    }
}

/// More columns are too narrow for their figures.
constexpr std::size_t most_columns = 6;

template <class Cell>
std::vector<Cell> part_of(const std::vector<Cell>& cells, std::size_t first, std::size_t count) {
    const auto start = cells.begin() + static_cast<std::ptrdiff_t>(first);
    return {start, start + static_cast<std::ptrdiff_t>(std::min(count, cells.size() - first))};
}

/// Adds the grid as several that are narrow enough, about equally wide.
void split(const Grid& grid, std::vector<Grid>& parts) {
    const std::size_t columns = grid.columns.size();
    const std::size_t count = (columns + most_columns - 1) / most_columns;
    const std::size_t each = count == 0 ? 1 : (columns + count - 1) / count;
    for (std::size_t first = 0; first < columns; first += each) {
        Grid& part = parts.emplace_back(Grid{grid.heading, part_of(grid.columns, first, each), {}});
        for (const Grid::Row& row : grid.rows)
            part.rows.push_back({row.label, part_of(row.cells, first, each)});
    }
}

}  // namespace

Canvas draw_grids(const std::string& title, const std::vector<Grid>& wide, const std::string& axes) {
    std::vector<Grid> grids;
    for (const Grid& grid : wide)
        split(grid, grids);
    double top = axes.empty() ? 0.0 : 24.0;
    double height = top;
    for (const Grid& grid : grids)
        height += grid_height(grid);
    Canvas canvas(title, height);
    if (!axes.empty()) canvas.text(2.0, 14.0, shortened(axes, 62), Canvas::Anchor::start, "axis");
    for (const Grid& grid : grids) {
        draw_grid(grid, top, canvas);
        top += grid_height(grid);
    }
    return canvas;
}

}  // namespace clearway::report::detail
