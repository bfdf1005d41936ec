#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "results/store.hpp"

namespace clearway::results {

/// How the rows of a table are written.
enum class TableFormat : std::uint8_t {
    csv,   ///< RFC 4180: first a line of column names; empty cells for missing values.
    json,  ///< One array with an object per row, one row per line; null for missing values.
};

/// Whether the run folder has all tables, and its `results.sqlite` belongs to its study and was written from
/// the runs and errors that are there now. Reads every record: 0.03 ms for one of 100 KB.
/// Throws core::InputError for a database of another version and for a file that is not a database.
bool tables_are_current(const Store& store);
/// Names of the tables, `results.sqlite` among them, that are not as they were written. Empty without it;
/// tables in CSV that are missing are left out. Reads them whole. Throws core::InputError as above.
std::vector<std::string> edited_tables(const Store& store);

/// Names of the tables of a run folder's `results.sqlite` and of those that are read from the runs' event
/// logs each time (`signal_events`), in alphabetical order. Throws core::InputError as above.
std::vector<std::string> table_names(const Store& store);

/// Writes a table, row by row. Throws core::InputError as above, and for an unknown table, naming the known
/// ones.
void print_table(const Store& store, const std::string& table, TableFormat format, std::ostream& out);

}  // namespace clearway::results
