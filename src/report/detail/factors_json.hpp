#pragma once

#include <nlohmann/json.hpp>

#include "core/settings.hpp"

namespace clearway::report::detail {

/// `{"failure.dark_share": 0.3, "condition.failure": "B5"}`: values that are numbers become JSON numbers.
inline nlohmann::ordered_json factors_json(const core::Settings& factors) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const auto& [name, value] : factors) {
        const auto number = core::number_from(value);
        object[name] = number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(value);
    }
    return object;
}

}  // namespace clearway::report::detail
