#include "scenario/keys.hpp"

#include <fmt/format.h>

#include "scenario/detail/tables.hpp"
#include "scenario/overrides.hpp"

namespace clearway::scenario {
namespace {

/// The struct in an optional or a list.
template <class Value>
struct Held {
    using Type = Value;
};
template <class Value>
struct Held<std::optional<Value>> {
    using Type = Value;
};
template <class Value>
struct Held<std::vector<Value>> {
    using Type = Value;
};

template <class Struct>
core::FieldTable table_of(const std::string& key, const std::string& title, const std::string& summary) {
    return {title, summary, core::field_rows<Struct>(key + ".")};
}

}  // namespace

std::vector<core::FieldTable> key_tables() {
    std::vector<core::FieldTable> tables;
    detail::for_each_table([&]<class Member>(const detail::Table<Member>& table) {
        const std::string key = table.key;
        const std::string title = detail::IsList<Member>::value ? "[[" + key + "]]" : key;
        tables.push_back(table_of<typename Held<Member>::Type>(key, title, table.summary));
        if constexpr (std::is_same_v<Member, RoadCondition>)
            tables.push_back(table_of<Stretch>("road.stretch.NAME", "road.stretch.NAME",
                                               "Edges with a factor of their own, listed in `edges`"));
    });
    tables.push_back(
        table_of<OwnTypes>("measured.own_types", "measured.own_types", "Vehicles keep their own types"));
    tables.push_back(table_of<MeasuredType>("measured.type", "[[measured.type]]",
                                            "What a type of the measured demand becomes"));
    return tables;
}

core::FieldTable override_table() {
    core::FieldTable table{
        "Overrides",
        "Changes to any scenario: keys of `[overrides]`, `[[scenario]]` and `scenario.` factors in "
        "study files, keywords in Python, options on the command line",
        {}};
    for (const Override& override : overrides()) {
        core::SettingInfo& row = table.rows.emplace_back(override.value);
        row.source = fmt::format("`{}` {} `{}`", override.option,
                                 override.replaced.empty() ? "multiplies" : "sets", override.key);
    }
    return table;
}

core::SettingInfo detail::key_info(const std::string& key) {
    for (const core::FieldTable& table : key_tables()) {
        for (const core::SettingInfo& row : table.rows)
            if (row.name == key) return row;
    }
    return {};
}

std::optional<core::Problem> detail::set_key(ScenarioConfig& config, const std::string& key,
                                             const std::string& text, const std::string& where) {
    std::optional<core::Problem> problem;
    for_each_table([&]<class Member>(const Table<Member>& table) {
        if constexpr (core::HasFields<Member>) {
            Member& target = config.*table.member;
            core::for_each_field<Member>([&](const auto& field) {
                if (key == fmt::format("{}.{}", table.key, field.name))
                    problem = core::set_member(field, text, where, target.*field.member);
            });
        }
    });
    config.origins[key] = where;
    return problem;
}

}  // namespace clearway::scenario
