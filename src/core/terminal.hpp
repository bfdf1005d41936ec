#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace clearway::core {

/// Whether standard error is a terminal that can redraw a line: not one with TERM=dumb.
bool can_redraw();

/// Width in columns of the terminal on standard error: as the terminal reports it, else from the variable
/// COLUMNS, else 80.
std::size_t terminal_columns();

/// The text cut to `columns` characters of UTF-8.
std::string cut_to_columns(const std::string& text, std::size_t columns);

/// Characters of a text in UTF-8.
std::size_t characters_in(std::string_view text);

/// Columns of a terminal that help texts and lists keep to.
inline constexpr std::size_t help_columns = 80;

/// The words of `text` in lines of at most `help_columns`; lines after the first begin with `indent` spaces.
/// A word that is longer stands alone on its line. Spaces before the first line's words are kept. `join` ends
/// every line but the last.
std::string wrapped(const std::string& text, std::size_t indent, const std::string& join = "");

/// Draws one line on standard error in place of the line drawn before, cut so that it never wraps. For one
/// thread.
void draw_line(const std::string& text);

/// Ends the drawn line and leaves it on the terminal. Does nothing if none is drawn.
void end_drawn_line();
/// Erases the drawn line. Does nothing if none is drawn.
void clear_drawn_line();

/// Writes whole lines to standard error, after earlier standard output and below a drawn line.
void print_message(const std::string& lines);

}  // namespace clearway::core
