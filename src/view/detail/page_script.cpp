#include "view/detail/page_script.hpp"

// The assembler takes the file as it is: 1 MB as a C++ literal would take the compiler many seconds.
asm(".section .rodata\n"
    ".global clearway_page_script_begin\n"
    ".global clearway_page_script_end\n"
    "clearway_page_script_begin:\n"
    ".incbin \"" CLEARWAY_PAGE_SCRIPT
    "\"\n"
    "clearway_page_script_end:\n"
    ".byte 0\n"
    ".text\n");

extern "C" const char clearway_page_script_begin[];  // NOLINT(*-avoid-c-arrays): symbols of the assembler
extern "C" const char clearway_page_script_end[];    // NOLINT(*-avoid-c-arrays)

namespace clearway::view::detail {

std::string_view page_script() {
    return {clearway_page_script_begin,
            static_cast<std::size_t>(clearway_page_script_end - clearway_page_script_begin)};
}

std::string page_script_sha256() {
    constexpr std::string_view hex = CLEARWAY_PAGE_SHA256;
    constexpr int base = 16;
    std::string bytes;
    for (std::size_t at = 0; at < hex.size(); at += 2)
        bytes.push_back(static_cast<char>(std::stoi(std::string(hex.substr(at, 2)), nullptr, base)));
    return bytes;
}

}  // namespace clearway::view::detail
