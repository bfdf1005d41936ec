#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace clearway::loop {

/// Attaches to the simulation that an order file (experiment::AttachOrder) names, lets it go on under the
/// order's condition until it is empty or reaches its own end, and stores the run in a run folder of its own.
/// Throws core::EnvironmentError when no usable SUMO answers, core::InputError when its files cannot be used
/// here, core::SimulatorError when the simulation fails or the connection breaks.
core::ExitCode run_attached(const std::filesystem::path& order_file);

}  // namespace clearway::loop
