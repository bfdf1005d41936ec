#include "core/folder_name.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace clearway::core {

namespace {

bool is_plain(char letter) {
    const bool is_letter = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
    const bool is_digit = letter >= '0' && letter <= '9';
    return is_letter || is_digit || std::string_view("_-.").find(letter) != std::string_view::npos;
}

}  // namespace

bool is_folder_name(std::string_view name) {
    constexpr std::size_t longest = 100;
    const auto is_allowed = [](char letter) { return is_plain(letter) || letter == '+' || letter == '='; };
    return !name.empty() && name.size() <= longest && name.front() != '.' &&
           std::ranges::all_of(name, is_allowed);
}

void check_folder_name(const std::string& where, const std::string& name, std::vector<Problem>& problems) {
    if (is_folder_name(name)) return;
    problems.push_back({where, fmt::format("\"{}\" cannot be the name of a folder", name),
                        "1 to 100 letters, digits and _ - . + =, not starting with '.'", "Rename it"});
}

std::string as_folder_name(std::string text) {
    std::ranges::replace_if(
        text, [](char letter) { return !is_plain(letter); }, '_');
    return text;
}

}  // namespace clearway::core
