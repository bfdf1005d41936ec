#pragma once

#include <string>
#include <vector>

#include "report/detail/canvas.hpp"

namespace clearway::report::detail {

/// A cell of a grid chart. The tone is drawn besides the text, whose sign says the same without colour.
struct GridCell {
    std::string text;
    enum class Tone { empty, neutral, better, worse } tone = Tone::empty;
};

/// Rows of coloured cells under headings. Every row has a cell for each column.
struct Grid {
    std::string heading;
    std::vector<std::string> columns;
    struct Row {
        std::string label;
        std::vector<GridCell> cells;
    };
    std::vector<Row> rows;
};

/// More columns are too narrow for their figures.
inline constexpr std::size_t most_grid_columns = 8;

/// Units that a grid takes from its top.
double grid_height(const Grid& grid);
/// Draws a grid with its upper edge at `top`.
void draw_grid(const Grid& grid, double top, Canvas& canvas);

}  // namespace clearway::report::detail
