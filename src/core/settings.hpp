#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/number.hpp"
#include "core/spellings.hpp"

namespace clearway::core {

/// Members of field tables that are set by name: `mean_outage_s` -> `20`.
using Settings = std::map<std::string, std::string>;

/// One spelling for each number, `12` for `12.0`, so that equal settings are equal texts. Other text is
/// returned unchanged.
inline std::string setting_text(const std::string& text) {
    const auto number = number_from(text);
    return number ? fmt::format("{}", *number) : text;
}

/// The words allowed for a member of this type: the `spellings` of an enumeration, true and false for a bool.
/// Empty for numbers.
template <class Member>
std::vector<std::string> words_of() {
    std::vector<std::string> words;
    if constexpr (Spelled<Member>) {
        for (const auto& [value, word] : spellings(Member{}))
            words.emplace_back(word);
    } else if constexpr (std::is_same_v<Member, bool>) {
        words = {"true", "false"};
    }
    return words;
}

/// A member's value as the text that sets it; empty for an empty optional.
template <class Member>
std::string member_text(const Member& value) {
    if constexpr (Spelled<Member>) {
        return std::string(name(value));
    } else if constexpr (OptionalMember<Member>::value) {
        return value ? member_text(*value) : "";
    } else if constexpr (std::is_same_v<Member, std::vector<std::string>>) {
        return fmt::format("{}", fmt::join(value, ", "));
    } else {
        return fmt::format("{}", value);
    }
}

/// The numbers that a field takes, `0 to 10000 m`. A range without a unit has none to tell.
template <class Field>
std::string range_text(const Field& field) {
    std::string text = fmt::format("{} to {}", field.minimum, field.maximum);
    if constexpr (requires { field.unit; }) {
        const std::string unit = field.unit;
        if (!unit.empty() && unit != "1") text += " " + unit;
    }
    return text;
}

/// Sets one member from text: a number (whole for an integer member), true or false, a word from the
/// `spellings` of an enumeration, or the text itself. Returns what is wrong, if anything.
template <class Field, class Member>
std::optional<Problem> set_member(const Field& field, const std::string& text, const std::string& where,
                                  Member& target) {
    if constexpr (OptionalMember<Member>::value) {
        typename Member::value_type value{};
        std::optional<Problem> problem = set_member(field, text, where, value);
        if (problem) {
            problem->cure.clear();  // names the default of a member that always has a value
        } else {
            target = value;
        }
        return problem;
    } else if constexpr (std::is_same_v<Member, std::string>) {
        target = text;
        return std::nullopt;
    } else if constexpr (Spelled<Member>) {
        const auto value = value_from<Member>(text);
        if (!value)
            return Problem{where, fmt::format("\"{}\" is not known", text), spelling_list<Member>(), ""};
        target = *value;
        return std::nullopt;
    } else if constexpr (std::is_same_v<Member, bool>) {
        if (text != "true" && text != "false")
            return Problem{where, fmt::format("\"{}\" is not known", text), "true, false", ""};
        target = text == "true";
        return std::nullopt;
    } else {
        static_assert(std::is_arithmetic_v<Member>);
        const auto problem = [&](const char* what) {
            return Problem{where, fmt::format(fmt::runtime(what), text), range_text(field),
                           fmt::format("Give another number, or leave it out for {}", target)};
        };
        const auto number = number_from(text);
        if (!number) return problem("\"{}\" is not a number");
        if (!(*number >= field.minimum && *number <= field.maximum)) return problem("{} is out of range");
        const auto value = static_cast<Member>(*number);
        if (static_cast<double>(value) != *number) return problem("{} is not a whole number");
        target = value;
        return std::nullopt;
    }
}

/// The problem of a name that is not in `known`; lists them and suggests the nearest.
inline Problem unknown_setting(const std::string& where, const std::string& name,
                               const std::vector<std::string>& known) {
    return {where, "is unknown", listed(known), did_you_mean(name, known)};
}

/// Sets members of `targets` by name. Returns every problem: an unknown name (with the nearest known one), a
/// value of the wrong type or out of range. Messages put `where` before each name.
template <class... Structs>
std::vector<Problem> apply_settings(const Settings& settings, const std::string& where, Structs&... targets) {
    std::vector<Problem> problems;
    std::vector<std::string> names;
    [[maybe_unused]] const auto collect = [&]<class Struct>(const Struct&) {
        for_each_field<Struct>([&](const auto& field) { names.emplace_back(field.name); });
    };
    (collect(targets), ...);
    for (const auto& setting : settings) {
        const std::string& name = setting.first;  // clang 14 cannot capture a structured binding
        bool known = false;
        [[maybe_unused]] const auto set = [&]<class Struct>(Struct& target) {
            for_each_field<Struct>([&](const auto& field) {
                if (name != field.name) return;
                known = true;
                if (auto problem = set_member(field, setting.second, where + name, target.*field.member))
                    problems.push_back(*problem);
            });
        };
        (set(targets), ...);
        if (!known) problems.push_back(unknown_setting(where + name, name, names));
    }
    return problems;
}

/// The same, but throws core::InputError with every problem.
template <class... Structs>
void set_all(const Settings& settings, const std::string& where, Structs&... targets) {
    std::vector<Problem> problems = apply_settings(settings, where, targets...);
    if (!problems.empty()) throw InputError(std::move(problems));
}

/// One row of a field table, for listings.
struct SettingInfo {
    std::string name;
    std::string unit;                ///< SI symbol; "1" for ratios and counts, "" for words.
    double minimum = 0.0;            ///< For numbers; inclusive.
    double maximum = 0.0;            ///< For numbers; inclusive.
    std::vector<std::string> words;  ///< The allowed words if it is not a number.
    std::string preset;              ///< The default, as text.
    std::string doc;
    std::string source;  ///< Why the default is what it is.
};

/// All settings of one component, whichever structs hold them.
struct SettingsTable {
    std::vector<SettingInfo> rows;
    /// Checks settings with apply_settings on a temporary copy.
    std::vector<Problem> (*check)(const Settings& settings, const std::string& where) = nullptr;
};

/// The rows of a struct's field table; defaults are those of its members.
template <class Struct>
std::vector<SettingInfo> field_rows(const std::string& prefix = "") {
    std::vector<SettingInfo> rows;
    const Struct defaults{};
    for_each_field<Struct>([&](const auto& field) {
        using Member = std::remove_cvref_t<decltype(defaults.*field.member)>;
        rows.push_back({prefix + field.name, field.unit, field.minimum, field.maximum, words_of<Member>(),
                        member_text(defaults.*field.member), field.doc, field.source});
    });
    return rows;
}

/// Whether the default of each number lies in the range that its row gives.
template <class Struct>
constexpr bool defaults_lie_in_their_ranges() {
    const Struct defaults{};
    bool all = true;
    for_each_field<Struct>([&](const auto& field) {
        using Member = std::remove_cvref_t<decltype(defaults.*field.member)>;
        if constexpr (std::is_arithmetic_v<Member> && !std::is_same_v<Member, bool>) {
            const auto preset = static_cast<double>(defaults.*field.member);
            all = all && preset >= field.minimum && preset <= field.maximum;
        }
    });
    return all;
}

/// The table of one or more structs. The defaults are the initialisers of their members.
template <class... Structs>
SettingsTable settings_table() {
    static_assert((defaults_lie_in_their_ranges<Structs>() && ...),
                  "a default lies outside the range that its own row of the field table gives");
    SettingsTable table;
    [[maybe_unused]] const auto add = [&](std::vector<SettingInfo> rows) {
        std::ranges::move(rows, std::back_inserter(table.rows));
    };
    (add(field_rows<Structs>()), ...);
    table.check = [](const Settings& settings, const std::string& where) {
        std::tuple<Structs...> targets;
        return std::apply([&](auto&... target) { return apply_settings(settings, where, target...); },
                          targets);
    };
    return table;
}

/// The settings whose names begin with `component` and a dot; this prefix is removed.
inline Settings settings_of(const Settings& settings, const std::string& component) {
    Settings own;
    const std::string prefix = component + ".";
    for (const auto& [name, value] : settings) {
        if (name.starts_with(prefix)) own.emplace(name.substr(prefix.size()), value);
    }
    return own;
}

}  // namespace clearway::core
