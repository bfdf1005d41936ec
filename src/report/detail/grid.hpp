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

/// A drawing of grids below each other, under a line that says what their columns and rows are. A grid with
/// more columns than there is room for becomes several.
Canvas draw_grids(const std::string& title, const std::vector<Grid>& wide, const std::string& axes = {});

}  // namespace clearway::report::detail
