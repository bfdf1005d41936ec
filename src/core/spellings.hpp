#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace clearway::core {

/// The words for the enumerators of an enumeration in files and on the command line. They are declared once,
/// next to the enumeration:
///
///     constexpr core::Spellings<Colour, 2> spellings(Colour) {
///         return {{{Colour::red, "red"}, {Colour::blue, "blue"}}};
///     }
template <class Enum, std::size_t count>
using Spellings = std::array<std::pair<Enum, const char*>, count>;

template <class Enum>
concept Spelled = requires {
    spellings(Enum{});
};

/// The word of an enumerator. Modules import this into their namespaces: `traffic::name(kind)`.
template <Spelled Enum>
constexpr std::string_view name(Enum wanted) {
    for (const auto& [value, word] : spellings(Enum{})) {
        if (value == wanted) return word;
    }
    return "";
}

/// The enumerator of a word; nothing when it is not known.
template <Spelled Enum>
constexpr std::optional<Enum> value_from(std::string_view wanted) {
    for (const auto& [value, word] : spellings(Enum{})) {
        if (wanted == word) return value;
    }
    return std::nullopt;
}

/// All words of an enumeration, `a, b, c`.
template <Spelled Enum>
std::string spelling_list() {
    std::string list;
    for (const auto& [value, word] : spellings(Enum{}))
        list += (list.empty() ? "" : ", ") + std::string(word);
    return list;
}

}  // namespace clearway::core
