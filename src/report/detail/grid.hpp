#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/detail/canvas.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// A cell of a grid chart. The tone is drawn besides the text, whose sign says the same without colour.
struct GridCell {
    std::string text;
    enum class Tone { empty, neutral, better, worse } tone = Tone::empty;
    std::string below = {};  ///< A second, smaller line: an interval. Grids with any have fewer columns.
};

/// CSS classes of a cell.
std::string style_of(GridCell::Tone tone);
/// Behind a difference whose interval excludes 0, but not with Holm's correction, and what legends say of it.
inline constexpr const char* shown_alone = " \u2020";
inline constexpr const char* shown_alone_words = "\u2020 significant alone, not after Holm's correction";
/// That mark where it belongs, however small the difference; else empty.
const char* alone_mark(const MaybeEstimate& difference, const std::optional<double>& holm_p);
const char* alone_mark(const ConditionFacts& condition, Measure measure);

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

/// Whether the text of any cell ends with a mark.
bool has_mark(const std::vector<Grid>& grids, std::string_view mark);
/// What the tones mean, and `shown_alone` where a cell has it.
std::vector<LegendEntry> tone_entries(const std::vector<Grid>& grids);

/// A drawing of grids below each other, under lines that say what cells, columns and rows are. A grid with
/// more columns than there is room for becomes several.
Canvas draw_grids(const std::string& title, const std::vector<Grid>& wide,
                  const std::vector<std::string>& axes = {});

}  // namespace clearway::report::detail
