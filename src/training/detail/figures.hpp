#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/fields.hpp"
#include "training/seeds.hpp"

namespace clearway::training::detail {

// How summaries and tables write numbers.

using Json = nlohmann::ordered_json;

template <class Value>
Json json_value(const Value& value) {
    return value;
}
template <class Value>
Json json_value(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

inline std::string field_name(const char* name, const char* unit) {
    return std::string(unit) == "1" ? name : fmt::format("{}_{}", name, unit);
}

/// A struct with a field table as an object; the unit is part of the key.
template <class Struct>
Json json_from(const Struct& value) {
    Json json = Json::object();
    core::for_each_field<Struct>([&](const auto& field) {
        const auto& member = value.*field.member;
        using Member = std::remove_cvref_t<decltype(member)>;
        Json& entry = json[field_name(field.name, field.unit)];
        if constexpr (std::is_enum_v<Member>) {
            for (const auto& [choice, word] : spellings(Member{})) {
                if (choice == member) entry = word;
            }
        } else {
            entry = json_value(member);
        }
    });
    return json;
}

template <class Value>
std::string csv_value(const Value& value) {
    return fmt::format("{}", value);
}
template <class Value>
std::string csv_value(const std::optional<Value>& value) {
    return value ? fmt::format("{}", *value) : std::string();
}
inline std::string csv_value(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

inline Json json_from_seeds(const std::vector<DataSeed>& seeds) {
    Json list = Json::array();
    for (const DataSeed& seed : seeds) {
        list.push_back({{"study_seed", seed.study_seed}, {"replication", seed.replication}});
    }
    return list;
}

}  // namespace clearway::training::detail
