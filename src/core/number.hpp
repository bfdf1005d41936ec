#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace clearway::core {

/// All of `text` as a number, whatever the locale; nothing when it is not one. Not checked: that it is
/// finite.
template <class Number = double>
std::optional<Number> number_from(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

}  // namespace clearway::core
