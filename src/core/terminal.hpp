#pragma once

#include <cstddef>
#include <string>

namespace clearway::core {

/// Width in columns of the terminal on standard error: as the terminal reports it, else from the variable
/// COLUMNS, else 80.
std::size_t terminal_columns();

/// The text cut to `columns` characters of UTF-8.
std::string cut_to_columns(const std::string& text, std::size_t columns);

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
