#include "experiment/settings_page.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "policy/policy.hpp"

namespace clearway::experiment {
namespace {

constexpr std::size_t columns = 80;

/// Wraps `text` to lines of at most `columns`, each starting with `indent`.
std::string wrapped(const std::string& text, const std::string& indent) {
    std::istringstream words(text);
    std::string lines;
    std::string line;
    for (std::string word; words >> word;) {
        if (!line.empty() && indent.size() + line.size() + 1 + word.size() > columns) {
            lines += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return lines + indent + line + "\n";
}

std::string unit_of(const core::SettingInfo& row) {
    return row.unit == "1" ? "" : row.unit;
}

/// `0 to 60`, or the allowed words.
std::string range_of(const core::SettingInfo& row) {
    return row.words.empty() ? fmt::format("{} to {}", row.minimum, row.maximum)
                             : fmt::format("{}", fmt::join(row.words, ", "));
}

/// Escapes bars, which would end a table cell.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
        text.insert(at, "\\");
    return text;
}

std::vector<std::string> names_of(const std::vector<Component>& components) {
    std::vector<std::string> names;
    for (const Component& component : components)
        names.push_back(component.name);
    return names;
}

}  // namespace

std::vector<Component> components_named(const std::string& name) {
    const std::vector<Component>& all = components();
    if (name.empty()) return all;
    std::vector<std::string> wanted = {name};
    std::vector<std::string> known = names_of(all);
    for (const policy::PolicyEntry& entry : policy::policies()) {
        if (entry.name == name) wanted = entry.components;
        if (std::ranges::find(known, entry.name) == known.end()) known.push_back(entry.name);
    }
    std::vector<Component> found;
    std::ranges::copy_if(all, std::back_inserter(found), [&](const Component& component) {
        return std::ranges::find(wanted, component.name) != wanted.end();
    });
    if (found.empty()) {
        const std::string near = core::nearest(name, known);
        throw core::InputError({"list settings", fmt::format("`{}` is unknown", name),
                                fmt::format("{}", fmt::join(known, ", ")),
                                near.empty() ? "" : fmt::format("Did you mean `{}`?", near)});
    }
    return found;
}

std::string settings_console(const std::vector<Component>& components) {
    std::string text;
    for (const Component& component : components) {
        text += text.empty() ? "" : "\n";
        text += wrapped(fmt::format("{}: {}", component.name, component.summary), "");
        for (const core::SettingInfo& row : component.table.rows) {
            const std::string unit = unit_of(row);
            text += wrapped(fmt::format("{}.{} = {}{}{} ({})", component.name, row.name, row.preset,
                                        unit.empty() ? "" : " ", unit, range_of(row)),
                            "  ");
            text += wrapped(row.doc + ".", "      ");
            if (!row.source.empty()) text += wrapped("Why: " + row.source + ".", "      ");
        }
    }
    return text;
}

std::string settings_json(const std::vector<Component>& components) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const Component& component : components) {
        for (const core::SettingInfo& row : component.table.rows) {
            Json item = {{"name", component.name + "." + row.name},
                         {"component", component.name},
                         {"unit", row.unit},
                         {"default", row.preset}};
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
    return list.dump(2) + "\n";
}

std::string settings_markdown(const std::vector<Component>& components) {
    std::string text =
        "# Settings\n\n"
        "Every number that a condition may set, by its full name: `--set preempt_signals.lead_s=12` on the\n"
        "command line, `set = { \"preempt_signals.lead_s\" = 12 }` in a `[[condition]]` of a study file, or\n"
        "`preempt_signals.lead_s = [4, 8, 16]` below `[factors]`. This page is generated from the program's\n"
        "tables: `clearway list settings --markdown > docs/reference/settings.md`.\n";
    for (const Component& component : components) {
        text += fmt::format("\n## {}\n\n{}.\n\n", component.name, component.summary);
        text +=
            "| name | default | unit | allowed | what it is | why this default "
            "|\n|---|---|---|---|---|---|\n";
        for (const core::SettingInfo& row : component.table.rows) {
            text += fmt::format("| `{}.{}` | {} | {} | {} | {} | {} |\n", component.name, row.name,
                                row.preset, unit_of(row), range_of(row), cell(row.doc), cell(row.source));
        }
    }
    return text;
}

}  // namespace clearway::experiment
