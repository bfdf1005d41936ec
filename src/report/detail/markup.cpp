#include "report/detail/markup.hpp"

#include <fmt/format.h>

namespace clearway::report::detail {
namespace {

std::string table_element(const DataTable& table, const char* more) {
    std::string html = fmt::format("<table class=\"data{}\"{}><thead><tr>",
                                   table.cells == DataTable::Cells::words ? " words" : "", more);
    for (const std::string& cell : table.head) {
        html += fmt::format("<th scope=\"col\">{}</th>", escaped(cell));
    }
    html += "</tr></thead><tbody>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (std::size_t column = 0; column < row.size(); ++column) {
            const char* const tag = column == 0 ? "th scope=\"row\"" : "td";
            html += fmt::format("<{}>{}</{}>", tag, escaped(row[column]), column == 0 ? "th" : "td");
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

}  // namespace clearway::report::detail
