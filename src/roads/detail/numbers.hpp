#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "core/number.hpp"

namespace clearway::roads::detail {

/// All of `text` as a finite number; nothing when it is not one.
inline std::optional<double> parse_number(std::string_view text) {
    const auto value = core::number_from(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Calls `visit` with each non-empty part of `text` between separators.
template <class Visitor>
void for_each_word(std::string_view text, char separator, const Visitor& visit) {
    while (!text.empty()) {
        const std::size_t end = text.find(separator);
        const std::string_view word = text.substr(0, end);
        if (!word.empty()) visit(word);
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    }
}

}  // namespace clearway::roads::detail
