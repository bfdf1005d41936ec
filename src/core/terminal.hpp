#pragma once

#include <cstddef>
#include <string>

namespace clearway::core {

/// Columns of the terminal behind standard error: what it says itself, else the variable COLUMNS, else 80.
std::size_t terminal_columns();

/// The text cut to `columns` characters of UTF-8.
std::string cut_to_columns(const std::string& text, std::size_t columns);

/// Draws one line on standard error in the place of the line drawn before, cut so that it never wraps.
/// For one thread.
void draw_line(const std::string& text);

/// Ends the drawn line, which stays; nothing where none is drawn.
void end_drawn_line();
/// Takes the drawn line away; nothing where none is drawn.
void clear_drawn_line();

/// Writes whole lines to standard error, behind what went to standard output before and below a drawn line.
void print_message(const std::string& lines);

}  // namespace clearway::core
