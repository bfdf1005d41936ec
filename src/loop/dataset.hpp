#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace clearway::loop {

/// Runs the simulation of an order file (experiment::DatasetOrder) without a policy and writes the data set
/// into its output folder. Prints one line about each file written. Throws core::Error.
core::ExitCode record_dataset(const std::filesystem::path& order_file);

}  // namespace clearway::loop
