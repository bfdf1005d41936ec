#include "report/detail/markup.hpp"

#include <fmt/format.h>

#include "report/detail/axes.hpp"

namespace clearway::report::detail {

std::string to_html(const DataTable& table) {
    std::string html = fmt::format("<div class=\"scroll\" tabindex=\"0\"><table class=\"data{}\"><thead><tr>",
                                   table.cells == DataTable::Cells::words ? " words" : "");
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
    return html + "</tbody></table></div>\n";
}

std::string to_html(const Figure& figure) {
    std::string html = fmt::format("<figure><figcaption>{}</figcaption>\n{}{}", escaped(figure.caption),
                                   figure.drawing, figure.legend);
    if (!figure.note.empty()) html += fmt::format("<p class=\"note\">{}</p>\n", escaped(figure.note));
    if (!figure.data.rows.empty()) {
        html += "<details><summary>Data</summary>\n" + to_html(figure.data) + "</details>";
    }
    return html + "</figure>\n";
}

std::string legend(const std::vector<std::pair<std::size_t, std::string>>& entries) {
    std::string html = "<ul class=\"legend\">";
    for (const auto& [series, name] : entries) {
        html += fmt::format("<li>{}{}</li>", swatch(series), escaped(name));
    }
    return html + "</ul>\n";
}

std::string condition_label(const ConditionFacts& condition) {
    std::string html = escaped(condition.title);
    if (condition.safety_checks_off) html += " <span class=\"unsafe\">safety checks off</span>";
    return html;
}

}  // namespace clearway::report::detail
