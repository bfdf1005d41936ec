#pragma once

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/csv.hpp"
#include "core/fields.hpp"
#include "training/arithmetic.hpp"
#include "training/output_folder.hpp"
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

/// The name with its unit, if it has one.
inline std::string field_name(const char* name, const char* unit) {
    const std::string suffix = unit;
    return suffix.empty() || suffix == "1" ? name : fmt::format("{}_{}", name, suffix);
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

/// How every summary begins.
inline Json summary_start(const Identity& identity, std::string_view outcome,
                          const std::filesystem::path& data) {
    Json summary = {{"format", "clearway training summary 1"},
                    {"mode", identity.at("mode")},
                    {"outcome", outcome},
                    {"data", data.string()}};
    summary.update(identity);
    return summary;
}

/// What the numbers were computed with; part of no identity, since another machine may go on.
inline Json json_from(const Arithmetic& arithmetic) {
    return {
        {"torch", arithmetic.torch},
        {"torch_kernels", arithmetic.kernels},
        {"blas", arithmetic.blas},
        {"blas_kernels", arithmetic.blas_kernels.empty() ? Json(nullptr) : Json(arithmetic.blas_kernels)}};
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
/// Which pairs a row of a table is about: their scenario or their failure, by name.
inline std::string csv_group(const std::string& name) {
    return name.empty() ? "all" : core::csv_text(name);
}

inline Json json_from(const SeedSplit& split) {
    Json json = Json::object();
    const std::initializer_list<std::pair<const char*, const std::vector<DataSeed>*>> parts = {
        {"train", &split.train}, {"validation", &split.validation}, {"test", &split.test}};
    for (const auto& [name, seeds] : parts) {
        Json& list = json[name] = Json::array();
        for (const DataSeed& seed : *seeds)
            list.push_back({{"study_seed", seed.study_seed}, {"replication", seed.replication}});
    }
    return json;
}

}  // namespace clearway::training::detail
