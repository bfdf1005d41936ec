#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/number.hpp"

namespace clearway::core {

/// `90s`, `10min` or `2h` in seconds; nothing for other text and for times outside 1 s to 1000 h.
inline std::optional<double> duration_from(std::string_view text) {
    const std::size_t unit_at = text.find_first_not_of("0123456789.");
    if (unit_at == std::string_view::npos) return std::nullopt;
    const std::string_view unit = text.substr(unit_at);
    const auto number = number_from(text.substr(0, unit_at));
    if (!number || (unit != "s" && unit != "min" && unit != "h")) return std::nullopt;
    const double seconds = *number * (unit == "s" ? 1.0 : unit == "min" ? 60.0 : 3600.0);
    if (!(seconds >= 1.0 && seconds <= 3.6e6)) return std::nullopt;
    return seconds;
}

}  // namespace clearway::core
