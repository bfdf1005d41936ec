#include "report/detail/writer.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace clearway::report::detail {
namespace {

/// Drops columns in which no row has a value, and the rows where only names are left.
void drop_unused(DataTable& table) {
    for (std::size_t column = table.head.size(); column-- > 1;) {
        const bool is_used = std::ranges::any_of(table.rows, [&](const auto& row) {
            return column < row.size() && !row[column].empty() && row[column] != missing(Script::typeset);
        });
        if (is_used) continue;
        const auto at = static_cast<std::ptrdiff_t>(column);
        table.head.erase(table.head.begin() + at);
        for (auto& row : table.rows)
            if (column < row.size()) row.erase(row.begin() + at);
    }
    if (table.head.size() < 2) table.rows.clear();
}

}  // namespace

std::string Writer::plain_name(const std::string& wanted) {
    constexpr std::size_t longest = 80;  // names of scenarios come from files and have no limit
    std::string name;
    for (const char letter : wanted) {
        const auto code = static_cast<unsigned char>(letter);
        const bool plain = code < 0x80 && std::isalnum(code) != 0;
        if (plain) name += static_cast<char>(std::tolower(code));
        if (!plain && !name.empty() && name.back() != '-') name += '-';
        if (name.size() == longest) break;
    }
    while (name.ends_with('-'))
        name.pop_back();
    return name;
}

std::string Writer::file_name(const std::string& wanted) {
    const std::string name = plain_name(wanted);
    std::string unique = name;
    for (int number = 2; !names_.insert(unique).second; ++number)
        unique = fmt::format("{}-{}", name, number);
    return unique;
}

void Writer::figure(Figure figure) {
    if (figure.drawing.empty()) return;
    drop_unused(figure.data);
    figure.name = file_name(figure.name);
    put(figure);
}

void Writer::figures(std::vector<Figure> figures) {
    const auto drawn = std::ranges::count_if(figures, [](const Figure& one) { return !one.drawing.empty(); });
    if (drawn == 0) return;
    // Three beside each other would leave the fourth alone.
    markup(fmt::format("<div class=\"figures{}\">\n", drawn == 1 ? " one" : drawn == 4 ? " pair" : ""));
    for (Figure& one : figures)
        figure(std::move(one));
    markup("</div>\n");
}

void Writer::table(Table table) {
    drop_unused(table.data);
    drop_unused(table.whole);
    if (table.data.rows.empty()) return;
    table.name = file_name(table.name);
    put(table);
}

void Writer::heading(const std::string& text) {
    markup(fmt::format("<h3>{}</h3>\n", escaped(text)));
}

void Writer::open_fold(const std::string& summary) {
    markup(fmt::format("<details class=\"fold\"><summary>{}</summary>\n", summary));
}

void Writer::close_fold() {
    markup("</details>\n");
}

}  // namespace clearway::report::detail
