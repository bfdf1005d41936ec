#include "campaign/printout.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/terminal.hpp"

namespace clearway::campaign {
namespace {

using core::Json;

std::string cell_text(const Json& cell) {
    if (cell.is_null()) return "-";
    if (cell.is_string()) return cell.get<std::string>();
    if (cell.is_number_float()) return fmt::format("{:g}", cell.get<double>());
    if (!cell.is_structured()) return cell.dump();
    std::string text;
    for (const auto& [key, value] : cell.items()) {
        text += text.empty() ? "" : cell.is_array() ? "+" : " ";
        text += (cell.is_array() ? "" : key + "=") + cell_text(value);
    }
    return text.empty() ? "-" : text;
}

Json json_of(const Table& table) {
    Json rows = Json::array();
    for (const Row& row : table.rows) {
        Json object = Json::object();
        for (std::size_t at = 0; at < table.columns.size(); ++at)
            if (!table.columns[at].key.empty()) object[table.columns[at].key] = row.cells[at];
        rows.push_back(std::move(object));
    }
    return rows;
}

/// A line of a table on a terminal: a last cell of several words goes on below itself, or, where it begins
/// far to the right, below the row.
std::string fitted(const std::string& line, std::size_t last_cell) {
    constexpr std::size_t rightmost = 56;
    constexpr std::size_t below = 4;
    if (line.find(' ', last_cell) == std::string::npos || line.find('\n') != std::string::npos) return line;
    return core::wrapped(line, last_cell <= rightmost ? last_cell : below);
}

/// A line under a row; one with a command is not broken.
std::string below_row(const std::string& line) {
    return line.find('`') == std::string::npos ? core::wrapped("    " + line, 8) : "    " + line;
}

}  // namespace

std::string text_of(const Table& table) {
    std::vector<std::string> lines(table.rows.size() + 1);
    std::vector<std::size_t> last_cells(lines.size());
    for (std::size_t at = 0; at < table.columns.size(); ++at) {
        if (table.columns[at].title.empty()) continue;
        std::vector<std::string> cells = {table.columns[at].title};
        bool numbers = !table.rows.empty();
        for (const Row& row : table.rows) {
            cells.push_back(cell_text(row.cells[at]));
            numbers = numbers && (row.cells[at].is_number() || row.cells[at].is_null());
        }
        std::size_t width = 0;
        for (const std::string& cell : cells)
            width = std::max(width, core::characters_in(cell));
        for (std::size_t line = 0; line < lines.size(); ++line) {
            const std::string gap(width - core::characters_in(cells[line]), ' ');
            if (!lines[line].empty()) lines[line] += "  ";
            last_cells[line] = lines[line].size();
            lines[line] += numbers ? gap + cells[line] : cells[line] + gap;
        }
    }
    std::string text;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        lines[line].erase(lines[line].find_last_not_of(' ') + 1);
        text += fitted(lines[line], last_cells[line]) + "\n";
        if (line == 0) continue;
        for (const std::string& below : table.rows[line - 1].below)
            text += below_row(below) + "\n";
    }
    return text;
}

void print(const Printout& printout, Printing printing) {
    if (printing == Printing::text) {
        fmt::print("{}", printout.head);
        for (const Table& table : printout.tables)
            if (!table.rows.empty()) fmt::print("{}", text_of(table));
        fmt::print("{}", printout.text);
        return;
    }
    Json json = printout.facts;
    for (const Table& table : printout.tables) {
        if (table.key.empty())
            json = json_of(table);
        else
            json[table.key] = json_of(table);
    }
    fmt::print("{}", core::to_text(json));
}

}  // namespace clearway::campaign
