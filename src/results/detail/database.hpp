#pragma once

#include <filesystem>

#include "results/store.hpp"

namespace clearway::results::detail {

/// Writes all of a study into one SQLite file: tables `study` (key, value), `runs`, `vehicles`, `failures`,
/// with the columns of the CSV files. Written aside and renamed. Throws core::EnvironmentError.
void write_database(const std::filesystem::path& file, const Results& results);

}  // namespace clearway::results::detail
