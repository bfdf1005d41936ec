#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/fields.hpp"
#include "training/arithmetic.hpp"
#include "training/output_folder.hpp"

namespace clearway::training::detail {

// How summaries and tables write numbers.

using Json = nlohmann::ordered_json;

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
            entry = core::name(member);
        } else if constexpr (requires { member.has_value(); }) {
            entry = member ? Json(*member) : Json(nullptr);
        } else {
            entry = member;
        }
    });
    return json;
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
inline std::string csv_value(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}
template <class Value>
std::string csv_value(const std::optional<Value>& value) {
    return value ? fmt::format("{}", *value) : std::string();
}

}  // namespace clearway::training::detail
