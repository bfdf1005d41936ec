#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace clearway::loop {

/// Does the work of one unit file (experiment::UnitSpec) as study::run asks: loads SUMO once, warms up once,
/// forks one child per condition that has no record yet, and stores what each child found. A child that fails
/// leaves a failure record with its cause, also when it was killed by a signal or for passing a limit of the
/// unit, and the others go on. Returns ok, or environment or conflict when the first child ends so. Throws
/// core::Error for faults before the first fork.
core::ExitCode run_unit(const std::filesystem::path& unit_file);

}  // namespace clearway::loop
