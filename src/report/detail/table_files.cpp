#include "report/detail/table_files.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/terminal.hpp"
#include "report/detail/canvas.hpp"

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

/// An estimate in a cell. The note is what stands behind it, such as `?`.
struct Interval {
    std::string mean, low, high, note;
};

/// The parts of `1.2 [0.9, 1.5] ?`; nothing for any other text.
std::optional<Interval> interval_in(const std::string& cell) {
    const std::size_t open = cell.find(" [");
    const std::size_t comma = cell.find(", ", open);
    const std::size_t close = cell.find(']', comma);
    if (open == std::string::npos || open == 0 || comma == std::string::npos || close == std::string::npos)
        return std::nullopt;
    const std::string rest = cell.substr(close + 1);
    if (!rest.empty() && !rest.starts_with(' ')) return std::nullopt;
    Interval parts = {cell.substr(0, open), cell.substr(open + 2, comma - open - 2),
                      cell.substr(comma + 2, close - comma - 2), rest.empty() ? rest : rest.substr(1)};
    for (const std::string* const part : {&parts.mean, &parts.low, &parts.high, &parts.note}) {
        if ((part->empty() && part != &parts.note) || part->find(' ') != std::string::npos)
            return std::nullopt;
    }
    return parts;
}

std::string line_of(const std::vector<std::string>& cells) {
    std::string line;
    for (const std::string& cell : cells)
        line += (line.empty() && &cell == cells.data() ? "" : ",") + core::csv_text(cell);
    return line + "\n";
}

/// The number of a cell without separators, with its sign; nothing for any other text.
std::optional<std::string> number_in(const std::string& cell) {
    std::string value = replaced(cell, minus, "-");
    if (is_grouped(value)) value = replaced(std::move(value), ",", "");
    const std::size_t sign = value.starts_with('-') || value.starts_with('+') ? 1 : 0;
    const std::size_t point = std::min(value.find('.'), value.size());
    const auto digits = [&](std::size_t from, std::size_t to) {
        return to > from && std::all_of(value.begin() + static_cast<std::ptrdiff_t>(from),
                                        value.begin() + static_cast<std::ptrdiff_t>(to), is_digit);
    };
    const bool is_number = digits(sign, point) && (point == value.size() || digits(point + 1, value.size()));
    return is_number ? std::optional(value) : std::nullopt;
}

/// How LaTeX sets a column.
struct Column {
    bool numbers = false;
    bool intervals = false;
    bool plus = false, minus = false;
    std::size_t whole = 1, decimals = 0;  ///< Most digits before and after the point.

    void include(const std::string& cell) {
        const std::optional<Interval> parts = interval_in(cell);
        const std::optional<std::string> number = number_in(parts ? parts->mean : cell);
        if (!number) return;
        numbers = true;
        intervals = intervals || parts.has_value();
        plus = plus || number->front() == '+';
        minus = minus || number->front() == '-';
        const std::size_t sign = number->front() == '+' || number->front() == '-' ? 1 : 0;
        const std::size_t point = std::min(number->find('.'), number->size());
        whole = std::max(whole, point - sign);
        if (point < number->size()) decimals = std::max(decimals, number->size() - point - 1);
    }
    std::string type(const char* of_words) const {
        if (!numbers) return of_words;
        return fmt::format("S[table-format={}{}.{}{}]{}",
                           plus    ? "+"
                           : minus ? "-"
                                   : "",
                           whole, decimals, plus ? ",retain-explicit-plus" : "", intervals ? "@{\\,}l" : "");
    }
    /// `words` are LaTeX.
    std::string head(const std::string& words) const {
        if (!numbers) return words;
        return intervals ? "\\multicolumn{2}{c}{" + words + "}" : "{" + words + "}";
    }
    std::string body(const std::string& cell) const {
        if (!numbers) return latex_escaped(cell);
        const std::optional<Interval> parts = interval_in(cell);
        const std::optional<std::string> number = number_in(parts ? parts->mean : cell);
        std::string text = number ? *number : "{" + latex_escaped(cell) + "}";
        if (!intervals) return text;
        const auto end = [](const std::string& value) {
            return "\\num{" + replaced(value, "\u2212", "-") + "}";
        };
        if (!parts) return text + " &";
        return text + " & [" + end(parts->low) + ", " + end(parts->high) + "]" +
               (parts->note.empty() ? "" : "\\," + latex_escaped(parts->note));
    }
};

std::vector<Column> columns_of(const DataTable& table) {
    std::vector<Column> columns(table.head.size());
    for (const auto& row : table.rows) {
        for (std::size_t column = 1; column < row.size(); ++column)
            if (table.cells == DataTable::Cells::numbers) columns[column].include(row[column]);
    }
    return columns;
}

/// Shrinks a table that is wider than the text, and no other.
constexpr const char* as_wide_as_the_text =
    "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}";
/// A column of sentences, in lines; shrunk to the width of the text they would be too small to read.
constexpr const char* paragraph = "p{0.7\\linewidth}";
constexpr std::size_t longest_word = 60;  // characters: a line of a usual page holds 80
/// Wider tables, in characters, are turned onto the long side of the page; still wider ones have parts.
constexpr std::size_t most_upright = 95;
constexpr std::size_t most_turned = 140;

bool is_long(const DataTable& table, std::size_t column) {
    return std::ranges::any_of(table.rows, [&](const std::vector<std::string>& row) {
        const auto letters = std::ranges::count_if(
            row[column], [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) != 0x80U; });
        return static_cast<std::size_t>(letters) > longest_word;
    });
}

/// Characters of the widest cell of a column, or of the longest word of its head, which is set in lines.
std::size_t width_of(const DataTable& table, std::size_t column) {
    std::size_t most = 0;
    for (const std::string& word : lines_of(table.head[column], 1))
        most = std::max(most, core::characters_in(word));
    for (const auto& row : table.rows)
        most = std::max(most, core::characters_in(row[column]));
    return std::min(most, longest_word);
}

std::size_t width_of(const DataTable& table) {
    constexpr std::size_t gap = 2;
    std::size_t all = 0;
    for (std::size_t column = 0; column < table.head.size(); ++column)
        all += width_of(table, column) + gap;
    return all;
}

/// A head in lines as wide as its column.
std::string latex_head(const std::string& text, std::size_t letters) {
    std::vector<std::string> lines = lines_of(text, letters);
    std::ranges::transform(lines, lines.begin(), latex_escaped);
    return lines.size() < 2 ? latex_escaped(text)
                            : fmt::format("\\shortstack{{{}}}", fmt::join(lines, "\\\\"));
}

/// A table that would be too small to read on the long side of a page, by columns, each part with the first.
std::vector<DataTable> parts_of(const DataTable& table) {
    const std::size_t first = width_of(table, 0);
    const std::size_t rest = width_of(table) - first;
    if (first + rest <= most_turned || table.head.size() < 3 || table.cells == DataTable::Cells::words)
        return {table};
    const std::size_t room = most_turned > 2 * first ? most_turned - first : most_turned / 2;
    const std::size_t count = std::min((rest + room - 1) / room, table.head.size() - 1);
    const std::size_t columns = (table.head.size() - 1 + count - 1) / count;
    std::vector<DataTable> parts;
    for (std::size_t from = 1; from < table.head.size(); from += columns) {
        const auto chosen = [&](const std::vector<std::string>& cells) {
            std::vector<std::string> some = {cells.front()};
            const std::size_t to = std::min(from + columns, cells.size());
            some.insert(some.end(), cells.begin() + static_cast<std::ptrdiff_t>(from),
                        cells.begin() + static_cast<std::ptrdiff_t>(to));
            return some;
        };
        DataTable part{chosen(table.head), {}, table.cells};
        for (const auto& row : table.rows)
            part.rows.push_back(chosen(row));
        parts.push_back(std::move(part));
    }
    return parts;
}

template <class Set>
std::string latex_line(const std::vector<std::string>& cells, const Set& set) {
    std::vector<std::string> typeset;
    for (std::size_t column = 0; column < cells.size(); ++column)
        typeset.push_back(set(column, cells[column]));
    return fmt::format("{} \\\\\n", fmt::join(typeset, " & "));
}

std::string latex_table(const DataTable& data, const std::string& caption, const std::string& label) {
    const std::vector<Column> columns = columns_of(data);
    std::string types;
    for (std::size_t column = 0; column < columns.size(); ++column) {
        const bool words = column == 0 || data.cells == DataTable::Cells::words;
        const bool lines = words && is_long(data, column);
        types += (column == 0 ? "" : " ") + columns[column].type(lines ? paragraph : "l");
    }
    const bool turned = width_of(data) > most_upright;
    const char* const kind = turned ? "sidewaystable" : "table";
    std::string text = fmt::format(
        "% needs \\usepackage{{booktabs,graphicx,{}siunitx}}\n\\begin{{{}}}\n\\centering\n\\caption{{{}}}\n"
        "\\label{{tab:{}}}\n{}{{%\n\\begin{{tabular}}{{{}}}\n\\toprule\n{}\\midrule\n",
        turned ? "rotating," : "", kind, latex_escaped(caption), label, as_wide_as_the_text, types,
        latex_line(data.head, [&](std::size_t at, const std::string& cell) {
            return columns[at].head(latex_head(cell, width_of(data, at)));
        }));
    for (const auto& row : data.rows)
        text +=
            latex_line(row, [&](std::size_t at, const std::string& cell) { return columns[at].body(cell); });
    return text + fmt::format("\\bottomrule\n\\end{{tabular}}}}\n\\end{{{}}}\n", kind);
}

}  // namespace

std::string to_csv(const DataTable& table) {
    std::vector<bool> wide(table.head.size(), false);
    std::vector<bool> noted(table.head.size(), false);
    for (const auto& row : table.rows) {
        for (std::size_t column = 0; column < row.size(); ++column) {
            const std::optional<Interval> parts = interval_in(row[column]);
            wide[column] = wide[column] || parts;
            noted[column] = noted[column] || (parts && !parts->note.empty());
        }
    }
    const bool several = std::ranges::count(wide, true) > 1;
    std::vector<std::string> cells;
    for (std::size_t column = 0; column < table.head.size(); ++column) {
        cells.push_back(table.head[column]);
        const std::string of = several ? table.head[column] + " " : "";
        if (wide[column]) cells.insert(cells.end(), {of + "low 95 %", of + "high 95 %"});
        if (noted[column]) cells.push_back(of + "note");
    }
    std::string text = line_of(cells);
    for (const auto& row : table.rows) {
        cells.clear();
        for (std::size_t column = 0; column < row.size(); ++column) {
            const std::optional<Interval> parts = interval_in(row[column]);
            cells.push_back(plain(parts ? parts->mean : row[column]));
            if (wide[column]) {
                cells.push_back(parts ? plain(parts->low) : "");
                cells.push_back(parts ? plain(parts->high) : "");
            }
            if (noted[column]) cells.push_back(parts ? parts->note : "");
        }
        text += line_of(cells);
    }
    return text;
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
        {"<", "$<$"},
        {">", "$>$"},
        {minus, "$-$"},
        {dash, "--"},
        {"\u2020", "\\dag{}"},
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

std::string to_latex(const Table& table) {
    const std::vector<DataTable> parts = parts_of(table.data);
    std::string text;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const bool is_one = parts.size() == 1;
        const std::string caption =
            table.caption + (is_one ? "" : fmt::format(" ({} of {})", part + 1, parts.size()));
        const std::string label = table.name + (part == 0 ? "" : fmt::format("-{}", part + 1));
        text += latex_table(parts[part], caption, label);
    }
    return text;
}

}  // namespace clearway::report::detail
