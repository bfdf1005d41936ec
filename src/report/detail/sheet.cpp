#include "report/detail/sheet.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/csv.hpp"
#include "core/terminal.hpp"
#include "report/detail/canvas.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::size_t column_gap = 2;
/// Three or four street names; ids of joined junctions name all their nodes.
constexpr std::size_t longest_on_page = 100;

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::string cell_words(const SheetCell& cell, Script script) {
    return std::visit(Overloaded{[&](std::monostate) { return missing(script); },
                                 [](std::size_t count) { return std::to_string(count); },
                                 [](SignalNumber number) { return fmt::format("#{}", number.value); },
                                 [&](const std::string& text) {
                                     return script == Script::plain
                                                ? printable(text)
                                                : shortened(printable(text), longest_on_page);
                                 },
                                 [](bool shown) { return std::string(shown ? "shown" : "not shown"); },
                                 [&](Share share) {
                                     return number(100.0 * share.value, {0, script});
                                 },
                                 [&](const MaybeEstimate& value) {
                                     return estimate(value, {1, script});
                                 }},
                      cell);
}

Json json_cell(const SheetCell& cell) {
    return std::visit(Overloaded{[](std::monostate) { return Json(nullptr); },
                                 [](Share share) { return Json(share.value); },
                                 [](SignalNumber number) { return Json(number.value); },
                                 [](const MaybeEstimate& value) { return estimate_json(value); },
                                 [](const auto& value) { return Json(value); }},
                      cell);
}

/// The cells of an estimate, or a single one.
std::vector<std::string> csv_cells(const SheetCell& cell) {
    if (const auto* const value = std::get_if<MaybeEstimate>(&cell)) {
        const analysis::Interval* const interval = analysis::shown_interval(*value);
        const auto end = [&](double analysis::Interval::*side) {
            return core::csv_cell(interval != nullptr ? std::optional(interval->*side) : std::nullopt);
        };
        return {core::csv_cell(mean_of(*value)), end(&analysis::Interval::low),
                end(&analysis::Interval::high)};
    }
    if (const auto* const share = std::get_if<Share>(&cell)) return {core::csv_cell(share->value)};
    if (const auto* const text = std::get_if<std::string>(&cell)) return {core::csv_text(*text)};
    return {std::holds_alternative<std::monostate>(cell) ? "" : json_cell(cell).dump()};
}

/// Whether a column holds estimates, which CSV spreads over three columns.
bool is_estimate(const Sheet& sheet, std::size_t column) {
    return !sheet.rows.empty() && std::holds_alternative<MaybeEstimate>(sheet.rows.front()[column]);
}

/// Whether people see a column: not if nothing can be said in any of its rows.
bool is_visible(const Sheet& sheet, std::size_t column) {
    const auto is_empty = [&](const std::vector<SheetCell>& row) {
        return std::holds_alternative<std::monostate>(row[column]);
    };
    return sheet.columns[column].shown != SheetColumn::Shown::in_data &&
           (sheet.rows.empty() || !std::ranges::all_of(sheet.rows, is_empty));
}

bool holds_text(const Sheet& sheet, std::size_t column) {
    return std::ranges::any_of(sheet.rows, [&](const std::vector<SheetCell>& row) {
        return std::holds_alternative<std::string>(row[column]) || std::holds_alternative<bool>(row[column]);
    });
}

/// A column as it is printed on a terminal, its title first.
struct TextColumn {
    std::vector<std::string> cells;
    bool left = false;
    bool holds_names = false;
    bool if_room = false;

    std::size_t width() const {
        std::size_t most = 0;
        for (const std::string& cell : cells)
            most = std::max(most, core::characters_in(cell));
        return most;
    }
};

std::vector<TextColumn> text_columns(const Sheet& sheet) {
    std::vector<TextColumn> columns;
    for (std::size_t at = 0; at < sheet.columns.size(); ++at) {
        if (!is_visible(sheet, at)) continue;
        TextColumn column{{sheet.columns[at].title}, holds_text(sheet, at)};
        column.if_room = sheet.columns[at].shown == SheetColumn::Shown::if_room;
        for (const std::vector<SheetCell>& row : sheet.rows) {
            column.cells.push_back(cell_words(row[at], Script::plain));
            column.holds_names = column.holds_names || std::holds_alternative<std::string>(row[at]);
        }
        columns.push_back(std::move(column));
    }
    return columns;
}

bool fits(const std::vector<TextColumn>& columns) {
    std::size_t total = 0;
    for (const TextColumn& column : columns)
        total += column.width() + column_gap;
    return total <= core::help_columns + column_gap;
}

/// Takes out what has no room: first the names, which it returns, then what may be left out.
std::vector<TextColumn> taken_out(std::vector<TextColumn>& columns) {
    std::vector<TextColumn> names;
    if (fits(columns)) return names;
    std::ranges::copy_if(columns, std::back_inserter(names), &TextColumn::holds_names);
    std::erase_if(columns, [](const TextColumn& column) { return column.holds_names; });
    if (!fits(columns)) std::erase_if(columns, [](const TextColumn& column) { return column.if_room; });
    return names;
}

}  // namespace

Json estimate_json(const MaybeEstimate& estimate) {
    if (!estimate) return nullptr;
    Json json = {{"mean", estimate->mean}, {"pairs", estimate->n}};
    put_ends(json, analysis::shown_interval(estimate), "low", "high");
    return json;
}

Json json_of(const Sheet& sheet) {
    Json rows = Json::array();
    for (const std::vector<SheetCell>& row : sheet.rows) {
        Json& object = rows.emplace_back(Json::object());
        for (std::size_t at = 0; at < row.size(); ++at)
            if (!sheet.columns[at].key.empty()) object[sheet.columns[at].key] = json_cell(row[at]);
    }
    return rows;
}

std::string csv_of(const Sheet& sheet) {
    std::vector<std::string> head;
    for (std::size_t at = 0; at < sheet.columns.size(); ++at) {
        const std::string& key = sheet.columns[at].key;
        if (key.empty()) continue;
        head.push_back(key);
        if (!is_estimate(sheet, at)) continue;
        const std::string stem = key.substr(0, key.size() - 2);
        head.insert(head.end(), {stem + "_low_s", stem + "_high_s"});
    }
    std::string csv = fmt::format("{}\n", fmt::join(head, ","));
    for (const std::vector<SheetCell>& row : sheet.rows) {
        std::vector<std::string> cells;
        for (std::size_t at = 0; at < row.size(); ++at)
            if (!sheet.columns[at].key.empty())
                std::ranges::move(csv_cells(row[at]), std::back_inserter(cells));
        csv += fmt::format("{}\n", fmt::join(cells, ","));
    }
    return csv;
}

std::string text_of(const Sheet& sheet) {
    std::vector<TextColumn> columns = text_columns(sheet);
    const std::vector<TextColumn> names = taken_out(columns);
    std::string text;
    for (std::size_t line = 0; line <= sheet.rows.size(); ++line) {
        std::string words;
        for (const TextColumn& column : columns) {
            const std::string& cell = column.cells[line];
            const std::string room(column.width() - core::characters_in(cell), ' ');
            if (!words.empty()) words += std::string(column_gap, ' ');
            words += column.left ? cell + room : room + cell;
        }
        words.erase(words.find_last_not_of(' ') + 1);
        text += words + "\n";
        for (const TextColumn& column : names)
            if (line > 0) text += core::wrapped("      " + column.cells[line], 6) + "\n";
    }
    return text;
}

DataTable data_table_of(const Sheet& sheet) {
    DataTable table;
    for (std::size_t at = 0; at < sheet.columns.size(); ++at)
        if (is_visible(sheet, at)) table.head.push_back(sheet.columns[at].title);
    for (const std::vector<SheetCell>& row : sheet.rows) {
        std::vector<std::string>& cells = table.rows.emplace_back();
        for (std::size_t at = 0; at < row.size(); ++at)
            if (is_visible(sheet, at)) cells.push_back(cell_words(row[at], Script::typeset));
    }
    return table;
}

}  // namespace clearway::report::detail
