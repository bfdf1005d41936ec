#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace clearway::loop {

/// Runs the simulation of an order file (experiment::LinkOrder) and writes a LinkRun for each predictor.
/// Throws core::Error.
core::ExitCode evaluate_links(const std::filesystem::path& order_file);

}  // namespace clearway::loop
