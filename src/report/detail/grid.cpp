#include "report/detail/grid.hpp"

namespace clearway::report::detail {
namespace {

constexpr double heading_height = 20.0;
constexpr double columns_height = 18.0;
constexpr double row_height = 24.0;
constexpr double cells_left = 124.0;
constexpr double cells_right = 396.0;
constexpr double gap = 2.0;
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

}  // namespace

double grid_height(const Grid& grid) {
    return (grid.heading.empty() ? 0.0 : heading_height) + columns_height +
           row_height * static_cast<double>(grid.rows.size()) + 8.0;
}

void draw_grid(const Grid& grid, double top, Canvas& canvas) {
    using Anchor = Canvas::Anchor;
    if (!grid.heading.empty()) {
        canvas.text(2.0, top + 14.0, shortened(grid.heading, 60), Anchor::start, "heading");
        top += heading_height;
    }
    const double width = (cells_right - cells_left) / static_cast<double>(grid.columns.size());
    const auto letters = static_cast<std::size_t>(width / 6.5);
    for (std::size_t column = 0; column < grid.columns.size(); ++column)
        canvas.text(cells_left + (static_cast<double>(column) + 0.5) * width, top + 12.0,
                    shortened(grid.columns[column], letters), Anchor::middle, "tick");
    top += columns_height;
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

}  // namespace clearway::report::detail
