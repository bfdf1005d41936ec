#pragma once

#include <string>
#include <vector>

#include "results/record.hpp"

namespace clearway::results {

/// A cell in which two records of a run differ, as in the CSV files.
struct CellDifference {
    std::string table;   ///< `provenance`, `metrics` or `vehicles`.
    std::string row;     ///< Of `vehicles`: `3 (h17)`, counted from 1; else empty.
    std::string column;  ///< Name with unit; `(row)` where one record has no such row.
    std::string one;
    std::string other;
};

/// All differences, in the order of tables, rows and columns. Empty: the records are the same.
std::vector<CellDifference> differences(const RunRecord& one, const RunRecord& other);

}  // namespace clearway::results
