#pragma once

#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "results/store.hpp"
#include "results/table_reader.hpp"

namespace clearway::results::detail {

/// A table which is made from the event log of each run when it is printed: the logs are larger than
/// everything else that a study's tables hold.
struct LogTable {
    const char* name;
    std::string (*header)();  ///< Without the columns of the run and without a newline.
    /// The rows of a run, likewise.
    std::vector<std::string> (*rows)(const std::vector<metrics::SignalEvent>& events);
};
std::span<const LogTable> log_tables();

/// Writes a table, run by run. Throws core::InputError for a damaged log, and where no run of the folder kept
/// one.
void print_log_table(const Store& store, const LogTable& table, TableFormat format, std::ostream& out);

}  // namespace clearway::results::detail
