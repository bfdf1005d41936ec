#include "core/field_page.hpp"

#include <algorithm>

#include "core/json.hpp"
#include "core/terminal.hpp"

namespace clearway::core {
namespace {

/// `text` in lines of a terminal, each behind `indent` spaces.
std::string indented(const std::string& text, std::size_t indent) {
    return wrapped(std::string(indent, ' ') + text, indent) + "\n";
}

std::string unit_of(const SettingInfo& row) {
    return row.unit == "1" ? "" : row.unit;
}

/// `0 to 60`, or the words; nothing for free text.
std::string range_of(const SettingInfo& row) {
    if (!row.words.empty()) return listed(row.words);
    return row.minimum == row.maximum ? "" : fmt::format("{} to {}", row.minimum, row.maximum);
}

std::string without_full_stop(std::string text) {
    if (text.ends_with('.')) text.pop_back();
    return text;
}

/// A bar would end a cell.
std::string cell(const std::string& of) {
    std::string text = without_full_stop(of);
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
        text.insert(at, "\\");
    return text;
}

std::string markdown_row(const SettingInfo& row, FieldUse use) {
    if (use == FieldUse::read)
        return fmt::format("| `{}` | {} | {} | {} |\n", row.name, unit_of(row), cell(row.doc),
                           cell(row.source));
    return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.name, cell(row.preset), unit_of(row),
                       range_of(row), cell(row.doc), cell(row.source));
}

/// `lead_s = 8 s (0 to 60)` or, of what is read, `travel_time_s, s`.
std::string head_of(const SettingInfo& row, FieldUse use) {
    const std::string unit = unit_of(row);
    if (use == FieldUse::read) return row.name + (unit.empty() ? "" : ", " + unit);
    const std::string range = range_of(row);
    return fmt::format("{} = {}{}{}{}", row.name, row.preset, unit.empty() ? "" : " ", unit,
                       range.empty() ? "" : " (" + range + ")");
}

std::string console_row(const SettingInfo& row, FieldUse use) {
    std::string text = indented(head_of(row, use), 2) + indented(without_full_stop(row.doc) + ".", 6);
    if (!row.source.empty())
        text +=
            indented((use == FieldUse::read ? "From: " : "Why: ") + without_full_stop(row.source) + ".", 6);
    return text;
}

}  // namespace

std::string field_lines(const std::vector<FieldTable>& tables) {
    std::string text;
    for (const FieldTable& table : tables) {
        text += text.empty() ? "" : "\n";
        text += indented(fmt::format("{}: {}", table.title, table.summary), 0);
        std::size_t width = 0;
        for (const SettingInfo& row : table.rows)
            width = std::max(width, row.name.size());
        for (const SettingInfo& row : table.rows) {
            const std::string preset = row.preset + (unit_of(row).empty() ? "" : " ") + unit_of(row);
            const std::string range = range_of(row);
            text += fmt::format("  {:<{}}  {:<10}{}{}\n", row.name, width, preset, range.empty() ? "" : "  ",
                                range);
        }
    }
    return text;
}

std::string fields_console(const std::vector<FieldTable>& tables, FieldUse use) {
    std::string text;
    for (const FieldTable& table : tables) {
        text += text.empty() ? "" : "\n";
        text += indented(fmt::format("{}: {}", table.title, table.summary), 0);
        for (const SettingInfo& row : table.rows)
            text += console_row(row, use);
    }
    return text;
}

std::string fields_json(const std::vector<FieldTable>& tables) {
    Json list = Json::array();
    for (const FieldTable& table : tables) {
        for (const SettingInfo& row : table.rows) {
            Json item = {
                {"table", table.title}, {"name", row.name}, {"unit", row.unit}, {"default", row.preset}};
            if (row.words.empty()) {
                item["minimum"] = row.minimum;
                item["maximum"] = row.maximum;
            } else {
                item["words"] = row.words;
            }
            item["description"] = row.doc;
            item["reason"] = row.source;
            list.push_back(std::move(item));
        }
    }
    return to_text(list);
}

std::string fields_markdown(const std::vector<FieldTable>& tables, FieldUse use) {
    const char* const head = use == FieldUse::set
                                 ? "| name | default | unit | allowed | what it is | why this default "
                                   "|\n|---|---|---|---|---|---|\n"
                                 : "| name | unit | what it is | from |\n|---|---|---|---|\n";
    std::string text;
    for (const FieldTable& table : tables) {
        text += fmt::format("\n## {}\n\n{}.\n\n{}", table.title, table.summary, head);
        for (const SettingInfo& row : table.rows)
            text += markdown_row(row, use);
    }
    return text;
}

}  // namespace clearway::core
