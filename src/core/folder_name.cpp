#include "core/folder_name.hpp"

#include <algorithm>

namespace clearway::core {

bool is_folder_name(std::string_view name) {
    constexpr std::size_t longest = 100;
    const auto is_allowed = [](char letter) {
        const bool is_letter = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
        const bool is_digit = letter >= '0' && letter <= '9';
        return is_letter || is_digit || std::string_view("_-.+=").find(letter) != std::string_view::npos;
    };
    return !name.empty() && name.size() <= longest && name.front() != '.' &&
           std::ranges::all_of(name, is_allowed);
}

}  // namespace clearway::core
