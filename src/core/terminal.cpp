#include "core/terminal.hpp"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace clearway::core {
namespace {

constexpr std::size_t usual_columns = 80;
constexpr std::size_t least_columns = 20;  // a terminal that reports fewer does not know its width

/// Whether a drawn line on standard error still lacks its newline. Global, because all writers share one
/// terminal.
bool is_line_drawn = false;

std::size_t columns_from(const char* text) {
    if (text == nullptr) return 0;
    const std::string_view digits = text;
    std::size_t columns = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), columns);
    return error == std::errc() && end == digits.data() + digits.size() ? columns : 0;
}

bool begins_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

void write(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

std::size_t terminal_columns() {
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= least_columns) return size.ws_col;
    const std::size_t columns = columns_from(std::getenv("COLUMNS"));
    return columns >= least_columns ? columns : usual_columns;
}

std::string cut_to_columns(const std::string& text, std::size_t columns) {
    std::size_t count = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (begins_character(text[at]) && count++ == columns) return text.substr(0, at);
    }
    return text;
}

void draw_line(const std::string& text) {
    std::fflush(stdout);
    // The last column stays free: some terminals wrap as soon as it is filled.
    write("\r" + cut_to_columns(text, terminal_columns() - 1) + "\x1b[K");
    is_line_drawn = true;
}

void end_drawn_line() {
    if (is_line_drawn) write("\n");
    is_line_drawn = false;
}

void clear_drawn_line() {
    if (is_line_drawn) write("\r\x1b[K");
    is_line_drawn = false;
}

void print_message(const std::string& lines) {
    std::fflush(stdout);
    end_drawn_line();
    write(lines);
}

}  // namespace clearway::core
