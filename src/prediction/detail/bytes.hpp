#pragma once

#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace clearway::prediction::detail {

static_assert(std::endian::native == std::endian::little, "numbers of these files are little-endian");

/// The little-endian number at `at`, or nothing when it does not lie within `bytes`.
template <class Number>
std::optional<Number> number_at(std::string_view bytes, std::size_t at) {
    if (at > bytes.size() || bytes.size() - at < sizeof(Number)) return std::nullopt;
    Number number;
    std::memcpy(&number, bytes.data() + at, sizeof(Number));
    return number;
}

template <class Number>
void append_number(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(Number));
}

/// `count` bytes from `at`, or nothing when they do not all lie within `bytes`.
inline std::optional<std::string_view> part_of(std::string_view bytes, std::size_t at, std::size_t count) {
    if (at > bytes.size() || bytes.size() - at < count) return std::nullopt;
    return bytes.substr(at, count);
}

}  // namespace clearway::prediction::detail
