#include "study/detail/read_settings.hpp"

#include <fmt/format.h>

#include "experiment/settings.hpp"

namespace clearway::study::detail {
namespace {

using Problems = std::vector<core::Problem>;

/// The file being read, and where results go.
struct Reading {
    const SettingsPlace& place;
    core::Settings& settings;
    Problems& problems;
};

void read_table(const toml::table& table, const std::string& prefix, const Reading& reading) {
    for (const auto& [key, node] : table) {
        const std::string name = prefix + std::string(key.str());
        if (const toml::table* const below = node.as_table()) {
            read_table(*below, name + ".", reading);
            continue;
        }
        const std::string where = fmt::format("{}:{}:{}: ", reading.place.file, node.source().begin.line,
                                              node.source().begin.column);
        const auto text = setting_value(node);
        if (!text) {
            reading.problems.push_back({where + name, "is not a value", "a number or a word", ""});
            continue;
        }
        const Problems found = experiment::check_setting(name, *text, where, reading.place.parts);
        reading.problems.insert(reading.problems.end(), found.begin(), found.end());
        if (!reading.settings.emplace(name, *text).second)
            reading.problems.push_back({where + name, "is set twice", "each setting once", "Remove one"});
    }
}

}  // namespace

std::optional<std::string> setting_value(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return *text;
    if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
    if (const auto number = node.value_exact<double>())
        return fmt::format("{}", *number + 0.0);  // not the negative zero
    if (const auto truth = node.value_exact<bool>()) return *truth ? "true" : "false";
    return std::nullopt;
}

core::Settings read_settings(const toml::table& table, const SettingsPlace& place, Problems& problems) {
    core::Settings settings;
    read_table(table, "", {place, settings, problems});
    return settings;
}

}  // namespace clearway::study::detail
