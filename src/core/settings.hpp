#pragma once

#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace clearway::core {

/// Members of a field table that are set by name: `mean_outage_s` -> `20`.
using Settings = std::map<std::string, std::string>;

/// The number that `text` is; nothing when it is none.
inline std::optional<double> number_from(const std::string& text) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// Sets one member from its text. Numbers and enumerations (by their `spellings`) alone.
template <class Field, class Member>
std::optional<Problem> set_member(const Field& field, const std::string& text, const std::string& where,
                                  Member& target) {
    if constexpr (std::is_enum_v<Member>) {
        std::string list;
        for (const auto& [value, spelling] : spellings(Member{})) {
            if (text == spelling) {
                target = value;
                return std::nullopt;
            }
            list += (list.empty() ? "" : ", ") + std::string(spelling);
        }
        return Problem{where, fmt::format("\"{}\" is not known", text), list, ""};
    } else {
        static_assert(std::is_same_v<Member, double>);
        const auto number = number_from(text);
        const std::string allowed = fmt::format("{} to {}", field.minimum, field.maximum);
        if (!number) return Problem{where, fmt::format("\"{}\" is not a number", text), allowed, ""};
        if (!(*number >= field.minimum && *number <= field.maximum))
            return Problem{where, fmt::format("{} is out of range", text), allowed, ""};
        target = *number;
        return std::nullopt;
    }
}

/// Sets members of `target` by name. Answers everything that is wrong: an unknown name (with the nearest), a
/// value of another type or out of its range. `where` stands before each name in messages.
template <class Struct>
std::vector<Problem> apply_settings(const Settings& settings, const std::string& where, Struct& target) {
    std::vector<Problem> problems;
    std::vector<std::string> names;
    std::string list;
    for_each_field<Struct>([&](const auto& field) {
        names.emplace_back(field.name);
        list += (list.empty() ? "" : ", ") + names.back();
    });
    for (const auto& setting : settings) {
        const std::string& name = setting.first;  // no binding: clang 14 cannot capture one
        bool known = false;
        for_each_field<Struct>([&](const auto& field) {
            if (name != field.name) return;
            known = true;
            if (auto problem = set_member(field, setting.second, where + name, target.*field.member))
                problems.push_back(*problem);
        });
        if (known) continue;
        const std::string near = nearest(name, names);
        problems.push_back(
            {where + name, "is unknown", list, near.empty() ? "" : fmt::format("Did you mean '{}'?", near)});
    }
    return problems;
}

}  // namespace clearway::core
