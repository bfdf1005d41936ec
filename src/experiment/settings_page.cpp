#include "experiment/settings_page.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/field_page.hpp"
#include "core/terminal.hpp"
#include "experiment/settings.hpp"
#include "policy/policy.hpp"

namespace clearway::experiment {
namespace {

std::vector<core::FieldTable> field_tables(const std::vector<Component>& components) {
    std::vector<core::FieldTable> tables;
    for (const Component& component : components) {
        core::FieldTable& table =
            tables.emplace_back(core::FieldTable{component.name, component.summary, component.table.rows});
        for (core::SettingInfo& row : table.rows)
            row.name = component.name + "." + row.name;
    }
    return tables;
}

/// What two rows have in common that mean the same in different components.
std::string content_of(const core::SettingInfo& row) {
    return fmt::format("{}|{}|{}|{}|{}", row.name.substr(row.name.find('.')), row.minimum, row.maximum,
                       row.preset, row.doc);
}

/// Takes the rows that this many components have alike out of their tables and puts them first, once each.
std::vector<core::FieldTable> with_shared_rows(std::vector<core::FieldTable> tables) {
    constexpr std::size_t least_alike = 3;
    std::map<std::string, std::vector<std::string>> owners;
    for (const core::FieldTable& table : tables) {
        for (const core::SettingInfo& row : table.rows)
            owners[content_of(row)].push_back(table.title);
    }
    core::FieldTable shared{"shared", "Settings that several parts have, each with a value of its own", {}};
    for (core::FieldTable& table : tables) {
        std::erase_if(table.rows, [&](const core::SettingInfo& row) {
            const std::vector<std::string>& alike = owners[content_of(row)];
            if (alike.size() < least_alike) return false;
            if (alike.front() == table.title) {
                core::SettingInfo& once = shared.rows.emplace_back(row);
                once.name = "PART" + row.name.substr(row.name.find('.'));
                once.doc += fmt::format(". PART: {}", core::listed(alike));
            }
            return true;
        });
    }
    if (shared.rows.empty()) return tables;
    std::erase_if(tables, [](const core::FieldTable& table) { return table.rows.empty(); });
    tables.insert(tables.begin(), std::move(shared));
    return tables;
}

std::vector<std::string> names_of(const std::vector<Component>& components) {
    return core::texts_of(components, &Component::name);
}

}  // namespace

std::vector<Component> components_named(const std::string& words) {
    const std::string name = words.substr(0, words.find('.'));  // of `preempt_signals.lead_s` the component
    const std::vector<Component>& all = components();
    if (name.empty()) return all;
    std::vector<std::string> wanted = {name};
    std::vector<std::string> known = names_of(all);
    for (const policy::PolicyEntry& entry : policy::policies()) {
        if (entry.name == name) wanted = entry.components;
        if (!core::contains(known, entry.name)) known.push_back(entry.name);
    }
    std::vector<Component> found;
    std::ranges::copy_if(all, std::back_inserter(found),
                         [&](const Component& component) { return core::contains(wanted, component.name); });
    if (found.empty()) {
        throw core::InputError({"list settings", fmt::format("`{}` is unknown", name), core::listed(known),
                                core::did_you_mean(name, known, check_setting(name, "", "").front().cure)});
    }
    return found;
}

std::string settings_lines(const std::vector<Component>& components) {
    return core::field_lines(with_shared_rows(field_tables(components)));
}

std::string settings_of_parts(const std::string& policy, const std::vector<Component>& parts) {
    std::string text = core::wrapped(
        fmt::format("{}: no settings of its own; it has those of the policies that it combines", policy), 0);
    for (const Component& part : parts)
        text += fmt::format("\n  {:<16} {:2} settings: clearway list settings {}", part.name,
                            part.table.rows.size(), part.name);
    return text + "\n";
}

std::string settings_console(const std::vector<Component>& components) {
    return core::fields_console(with_shared_rows(field_tables(components)), core::FieldUse::set);
}

std::string settings_json(const std::vector<Component>& components) {
    return core::fields_json(field_tables(components));
}

std::string settings_markdown(const std::vector<Component>& components) {
    return "# Settings\n\n"
           "Every number that a condition may set, by its full name: `--set preempt_signals.lead_s=12` on "
           "the\n"
           "command line, `set = { \"preempt_signals.lead_s\" = 12 }` in a `[[condition]]` of a study file, "
           "or\n"
           "`preempt_signals.lead_s = [4, 8, 16]` below `[factors]`. The conditions are about emergency "
           "vehicles\n"
           "(EV) and the traffic around them. This page is generated from the program's tables:\n"
           "`clearway list settings --markdown > docs/reference/settings.md`.\n" +
           core::fields_markdown(with_shared_rows(field_tables(components)), core::FieldUse::set);
}

}  // namespace clearway::experiment
