#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace clearway::roads::detail {

/// Parses all of `text` as a finite number, independent of the locale; nothing when it is not one.
inline std::optional<double> parse_number(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
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
