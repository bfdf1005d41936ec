#pragma once

#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/json.hpp"
#include "core/number.hpp"

namespace clearway::core {

/// Text as a cell of a CSV file (RFC 4180): quoted only if it has to be.
std::string csv_text(std::string_view text);

/// A value as a cell. Numbers get the shortest text that reads back as the same number; an empty optional
/// gives an empty cell.
template <class Value>
std::string csv_cell(const Value& value) {
    if constexpr (OptionalMember<Value>::value) {
        return value ? csv_cell(*value) : std::string();
    } else if constexpr (std::is_arithmetic_v<Value>) {
        return fmt::format("{}", value);
    } else {
        return csv_text(value);
    }
}

/// `,name` for every member of a field table.
template <class Struct>
void append_header(std::string& line) {
    for_each_field<Struct>([&](const auto& field) { line += fmt::format(",{}", field.name); });
}

/// `,value` for every member of a field table; nothing after the comma for an empty optional.
template <class Struct>
void append_cells(std::string& line, const Struct& source) {
    for_each_field<Struct>([&](const auto& field) { line += "," + csv_cell(source.*field.member); });
}

/// As many commas as `append_cells` would write.
template <class Struct>
void append_empty_cells(std::string& line) {
    for_each_field<Struct>([&](const auto&) { line += ","; });
}

/// Splits off the first line, without its end.
std::string_view take_line(std::string_view& text);

/// Splits a CSV text row by row; rows end with a line feed, or with a carriage return before it. Only quoted
/// cells are copied, because a report spends most of its time reading runs. The text must outlive the reader.
class CsvReader {
  public:
    explicit CsvReader(std::string_view text) : text_(text) {}

    /// Moves to the next row; false at the end. Throws std::runtime_error for a quote that is not closed.
    bool next();
    /// The cells of the row, valid until the next one; at least one.
    const std::vector<std::string_view>& cells() const { return cells_; }

  private:
    /// These return whether the row continues.
    bool read_cell();
    bool read_quoted_cell(std::size_t start);
    bool pass_separator();
    bool is_at_end_of_row() const;

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<std::string_view> cells_;
    std::deque<std::string> unquoted_;  ///< Unquoted text that `cells_` refers to.
};

/// The inverse of `csv_cell`. Throws std::runtime_error for text that is not such a value.
template <class Value>
void read_cell(std::string_view cell, Value& target) {
    if constexpr (OptionalMember<Value>::value) {
        if (cell.empty()) {
            target = std::nullopt;
        } else {
            target.emplace();
            read_cell(cell, *target);
        }
    } else if constexpr (std::is_arithmetic_v<Value>) {
        const auto number = number_from<Value>(cell);
        if (!number) throw std::runtime_error(fmt::format("\"{}\" is not a number", cell));
        target = *number;
    } else {
        target = cell;
    }
}

}  // namespace clearway::core
