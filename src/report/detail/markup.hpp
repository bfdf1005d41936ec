#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "report/facts.hpp"

namespace clearway::report::detail {

/// A plain table: the first column holds names, the others numbers. All cells are escaped here.
struct DataTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
    enum class Cells { numbers, words } cells = Cells::numbers;
};
std::string to_html(const DataTable& table);

/// `coarse_step_sentence` as a marked paragraph; empty for finer steps.
std::string coarse_step_note(double step_length_s);

/// CSS classes of tables by the width that they need, and the room up to which they become lists, a line for
/// each cell, px. With more room they scroll sideways. Cells of such tables carry the words of their column
/// in `data-label`.
struct TableWidth {
    const char* name;
    double needed_px;  ///< At most.
    int room_px;
};
inline constexpr std::array<TableWidth, 4> table_widths = {
    {{"wide", 560, 560},
     {"wider", 880, 880},
     {"widest", 2000, 880},
     {"list", std::numeric_limits<double>::infinity(), 10000}}};

/// A table of its own, not the data of a figure.
struct Table {
    std::string name;  ///< Of its files, without ending; made safe and unique by the writer.
    std::string caption;
    DataTable data;
    /// Markup to show instead of `data`, which then serves downloads alone; empty for most tables.
    std::string markup = {};
    /// What CSV holds instead of `data` where readers are spared a column; without rows for most tables.
    DataTable whole = {};

    const DataTable& csv() const { return whole.rows.empty() ? data : whole; }
};

/// A figure: a drawing and the data behind it. Without a drawing there is nothing to show.
struct Figure {
    std::string name;  ///< Of its files, without ending; made safe and unique by the writer.
    std::string caption;
    std::string drawing;  ///< One `<svg>` element, legend included.
    std::string note;
    DataTable data;
};

std::string to_html(const Figure& figure);
std::string to_html(const Table& table);

/// The title as markup, escaped, with a mark if safety checks were off.
std::string condition_label(const ConditionFacts& condition);

}  // namespace clearway::report::detail
