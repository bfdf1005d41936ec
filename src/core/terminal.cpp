#include "core/terminal.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

#include "core/number.hpp"

namespace clearway::core {
namespace {

constexpr std::size_t usual_columns = 80;
constexpr std::size_t least_columns = 20;  // a terminal that reports fewer does not know its width

/// Whether a drawn line on standard error still lacks its newline. Global, because all writers share one
/// terminal.
bool is_line_drawn = false;

std::size_t columns_from(const char* text) {
    return text == nullptr ? 0 : number_from<std::size_t>(text).value_or(0);
}

bool begins_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

void write(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

bool can_redraw() {
    const char* const kind = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) != 0 && (kind == nullptr || std::string_view(kind) != "dumb");
}

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

std::size_t characters_in(std::string_view text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string wrapped(const std::string& text, std::size_t indent, const std::string& join) {
    std::string result;
    std::string line = text;
    while (line.size() > help_columns) {
        const std::size_t first = line.find_first_not_of(' ');
        std::size_t end = line.rfind(' ', help_columns - join.size());
        if (end == std::string::npos || end <= first) end = line.find(' ', first);
        if (end == std::string::npos) break;
        result += line.substr(0, line.find_last_not_of(' ', end) + 1) + join + '\n';
        line = std::string(indent, ' ') + line.substr(line.find_first_not_of(' ', end));
    }
    return result + line;
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
