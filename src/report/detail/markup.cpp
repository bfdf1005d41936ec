#include "report/detail/markup.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/terminal.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

/// Width of the longest piece that a line cannot break, px.
double unbroken_px(const std::string& cell) {
    constexpr double letter_px = 8.0;  // of a digit of .88rem, rounded up
    std::size_t longest = 0;
    for (std::size_t from = 0; from < cell.size();) {
        const std::size_t to = std::min(cell.find(' ', from), cell.size());
        longest = std::max(longest, core::characters_in(cell.substr(from, to - from)));
        from = to + 1;
    }
    return letter_px * static_cast<double>(longest);
}

/// The class of a table whose narrowest form needs more than a phone, a tablet or a desk has; else empty.
const char* width_class(const DataTable& table) {
    constexpr double padding_px = 21.0;
    constexpr double names_px = 120.0;  // the first column, whose words may be broken
    double needed_px = names_px;
    for (std::size_t column = 1; column < table.head.size(); ++column) {
        double column_px = unbroken_px(table.head[column]);
        for (const auto& row : table.rows)
            column_px = std::max(column_px, column < row.size() ? unbroken_px(row[column]) : 0.0);
        const bool breaks = table.cells == DataTable::Cells::words;
        needed_px += padding_px + (breaks ? std::min(column_px, names_px) : column_px);
    }
    constexpr double phone_px = 328.0;  // 360 px without margins
    if (needed_px <= phone_px) return "";
    return std::ranges::find_if(table_widths,
                                [&](const TableWidth& width) { return needed_px <= width.needed_px; })
        ->name;
}

/// `kind` is a CSS class, which the page's script reads.
std::string table_element(const DataTable& table, const char* more, const char* kind = "data") {
    const std::string width = width_class(table);
    std::string html = fmt::format("<table class=\"{}{}{}\"{}><thead><tr>", kind,
                                   table.cells == DataTable::Cells::words ? " words" : "",
                                   width.empty() ? "" : " " + width, more);
    for (const std::string& cell : table.head) {
        html += fmt::format("<th scope=\"col\">{}</th>", escaped(cell));
    }
    html += "</tr></thead><tbody>\n";
    for (const auto& row : table.rows) {
        html += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(row.front()));
        for (std::size_t column = 1; column < row.size(); ++column) {
            html += width.empty() || *more != '\0'
                        ? fmt::format("<td>{}</td>", escaped(row[column]))
                        : fmt::format("<td data-label=\"{}\">{}</td>", escaped(table.head[column]),
                                      escaped(row[column]));
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table>";
}

}  // namespace

std::string to_html(const DataTable& table) {
    return "<div class=\"scroll\" tabindex=\"0\">" + table_element(table, "") + "</div>\n";
}

std::string to_html(const Table& table) {
    const std::string id = table.name.empty() ? "" : fmt::format(" id=\"{}\"", table.name);
    std::string html = fmt::format("<div class=\"table\"{}>", id);
    if (!table.caption.empty()) html += fmt::format("<p class=\"caption\">{}</p>\n", escaped(table.caption));
    html += table.markup.empty() ? to_html(table.data) : table.markup + table_element(table.data, " hidden");
    if (!table.whole.rows.empty()) html += table_element(table.whole, " hidden", "whole");
    return html + "</div>\n";
}

std::string to_html(const Figure& figure) {
    const std::string id = figure.name.empty() ? "" : fmt::format(" id=\"{}\"", figure.name);
    std::string html =
        fmt::format("<figure{}><figcaption>{}</figcaption>\n{}", id, escaped(figure.caption), figure.drawing);
    if (!figure.note.empty()) html += fmt::format("<p class=\"note\">{}</p>\n", escaped(figure.note));
    if (!figure.data.rows.empty()) {
        html += "<details><summary>Data</summary>\n" + to_html(figure.data) + "</details>";
    }
    return html + "</figure>\n";
}

std::string condition_label(const ConditionFacts& condition) {
    std::string html = escaped(condition.title);
    if (condition.is_unchecked()) html += " <span class=\"unsafe\">safety checks off</span>";
    return html;
}

std::string coarse_step_note(double step_length_s) {
    const std::string words = coarse_step_sentence(step_length_s);
    return words.empty() ? words : fmt::format("<p class=\"note\">(!) {}</p>\n", escaped(words));
}

}  // namespace clearway::report::detail
