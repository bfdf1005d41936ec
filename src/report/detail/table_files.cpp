#include "report/detail/table_files.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/csv.hpp"
#include "core/error.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::string_view minus = "\u2212";
constexpr std::string_view dash = "\u2013";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

/// Whether a number is written with thousands separators: `12,345` or `-1,234.5`.
bool is_grouped(std::string_view text) {
    if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.remove_prefix(1);
    const std::size_t point = text.find('.');
    if (point != std::string_view::npos) {
        const std::string_view decimals = text.substr(point + 1);
        if (decimals.empty() || !std::ranges::all_of(decimals, is_digit)) return false;
        text = text.substr(0, point);
    }
    const std::size_t first = text.find(',');
    if (first == std::string_view::npos || first == 0 || first > 3) return false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const bool separator = at >= first && (at - first) % 4 == 0;
        if (separator ? text[at] != ',' : !is_digit(text[at])) return false;
    }
    return (text.size() - first) % 4 == 0;
}

std::string plain(const std::string& cell) {
    std::string value = replaced(cell, minus, "-");
    if (value == dash) return {};
    if (is_grouped(value)) value = replaced(std::move(value), ",", "");
    if (value.size() > 1 && value[0] == '+' && (is_digit(value[1]) || value[1] == '.')) value.erase(0, 1);
    return value;
}

using Interval = std::array<std::string, 3>;  // mean, low, high

/// The parts of `1.2 [0.9, 1.5]`; nothing for any other text.
std::optional<Interval> interval_in(const std::string& cell) {
    const std::size_t open = cell.find(" [");
    const std::size_t comma = cell.find(", ", open);
    if (open == std::string::npos || open == 0 || comma == std::string::npos || !cell.ends_with("]"))
        return std::nullopt;
    Interval parts = {cell.substr(0, open), cell.substr(open + 2, comma - open - 2),
                      cell.substr(comma + 2, cell.size() - comma - 3)};
    for (const std::string& part : parts) {
        if (part.empty() || part.find(' ') != std::string::npos) return std::nullopt;
    }
    return parts;
}

std::string line_of(const std::vector<std::string>& cells) {
    std::string line;
    for (const std::string& cell : cells)
        line += (line.empty() && &cell == cells.data() ? "" : ",") + core::csv_text(cell);
    return line + "\n";
}

std::string latex_escaped(const std::string& text) {
    static const std::vector<std::pair<std::string_view, std::string_view>> words = {
        {"\\", "\\textbackslash{}"},
        {"{", "\\{"},
        {"}", "\\}"},
        {"&", "\\&"},
        {"%", "\\%"},
        {"$", "\\$"},
        {"#", "\\#"},
        {"_", "\\_"},
        {"~", "\\textasciitilde{}"},
        {"^", "\\textasciicircum{}"},
        {minus, "$-$"},
        {dash, "--"},
        {"\u00b1", "$\\pm$"}};
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const auto found = std::ranges::find_if(
            words, [&](const auto& word) { return text.compare(at, word.first.size(), word.first) == 0; });
        result += found == words.end() ? std::string_view(text).substr(at, 1) : found->second;
        at += found == words.end() ? 1 : found->first.size();
    }
    return result;
}

std::string latex_line(const std::vector<std::string>& cells) {
    std::vector<std::string> escaped_cells =
        core::texts_of(cells, [](const std::string& cell) { return latex_escaped(cell); });
    return fmt::format("{} \\\\\n", fmt::join(escaped_cells, " & "));
}

}  // namespace

std::string to_csv(const DataTable& table) {
    std::vector<bool> wide(table.head.size(), false);
    for (const auto& row : table.rows) {
        for (std::size_t column = 0; column < row.size(); ++column)
            wide[column] = wide[column] || interval_in(row[column]).has_value();
    }
    std::vector<std::string> cells;
    for (std::size_t column = 0; column < table.head.size(); ++column) {
        cells.push_back(table.head[column]);
        if (wide[column]) cells.insert(cells.end(), {"low 95 %", "high 95 %"});
    }
    std::string text = line_of(cells);
    for (const auto& row : table.rows) {
        cells.clear();
        for (std::size_t column = 0; column < row.size(); ++column) {
            const std::optional<Interval> parts = interval_in(row[column]);
            cells.push_back(plain(parts ? (*parts)[0] : row[column]));
            if (wide[column]) {
                cells.push_back(parts ? plain((*parts)[1]) : "");
                cells.push_back(parts ? plain((*parts)[2]) : "");
            }
        }
        text += line_of(cells);
    }
    return text;
}

std::string to_latex(const DataTable& table) {
    std::string text = fmt::format("\\begin{{tabular}}{{l{}}}\n\\toprule\n{}\\midrule\n",
                                   std::string(table.head.empty() ? 0 : table.head.size() - 1,
                                               table.cells == DataTable::Cells::words ? 'l' : 'r'),
                                   latex_line(table.head));
    for (const auto& row : table.rows)
        text += latex_line(row);
    return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace clearway::report::detail
