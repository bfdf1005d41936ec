#pragma once

#include <string>
#include <vector>

#include "results/store.hpp"

namespace clearway::results {

/// A value in which two records of a run differ, as their files spell it.
struct CellDifference {
    /// `metrics`, `leases`, `traffic.holds`, `vehicles`, `signal_events`, ...; `run` for values that are in
    /// no table of `run.json`, such as hashes.
    std::string table;
    std::string row;     ///< Of tables with rows: `3 (h17)`, counted from 1, with its first text; else empty.
    std::string column;  ///< Name with unit; `(row)`, `(columns)` where these differ.
    std::string one;
    std::string other;
};

/// Cells of a table above which their number no longer matters.
inline constexpr std::size_t most_differences = 1000;

/// The differences between the records of a run in two stores, in the order of `run.json`; of each table at
/// most one more than `most_differences`. Folders of the same parts and models do not count. The files are
/// compared, not what a reader takes from them, so that whatever is written into a record counts. Timing is
/// no part of it. Empty: the records are the same. Assumes that the run is complete in both stores and that
/// Store::check accepts both. Throws core::InputError for a table that is no CSV or a file that is missing.
std::vector<CellDifference> differences(const Store& one, const Store& other, const experiment::RunKey& key);

}  // namespace clearway::results
