#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "results/store.hpp"

namespace clearway::results {

/// How the rows of a table are written.
enum class TableFormat : std::uint8_t {
    csv,   ///< RFC 4180, a line of column names first, empty cells for what is not available.
    json,  ///< One array with an object for each row, one row a line, null for what is not available.
};

/// Whether the run folder's `results.sqlite` is of its study and holds all runs and errors that there are.
/// Throws core::InputError for a database of another version and for a file that is none.
bool tables_are_current(const Store& store);

/// Names of the tables of a run folder's `results.sqlite`, in alphabetical order. Throws core::InputError as
/// above.
std::vector<std::string> table_names(const Store& store);

/// Writes a table, row by row. Throws core::InputError as above and for an unknown table, naming those there
/// are.
void print_table(const Store& store, const std::string& table, TableFormat format, std::ostream& out);

}  // namespace clearway::results
