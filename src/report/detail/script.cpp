#include "report/detail/script.hpp"

#include <cstdint>

namespace clearway::report::detail {

std::string policy_source(std::string_view sha256) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto digit = [&](std::size_t at) -> std::uint32_t {
        if (at >= sha256.size()) return 0;
        const char letter = sha256[at];
        return static_cast<std::uint32_t>(letter <= '9' ? letter - '0' : letter - 'a' + 10);
    };
    std::string text = "sha256-";
    for (std::size_t at = 0; at < sha256.size(); at += 3) {  // three digits, 12 bits, are two letters
        const std::uint32_t bits = digit(at) << 8U | digit(at + 1) << 4U | digit(at + 2);
        text += letters[bits >> 6U];
        text += letters[bits & 63U];
    }
    // 32 bytes are 43 letters and one to fill up.
    text.back() = '=';
    return text;
}

}  // namespace clearway::report::detail
