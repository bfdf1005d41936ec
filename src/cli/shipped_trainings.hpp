#pragma once

#include <filesystem>

namespace clearway::cli {

/// Copies what the trainings of the shipped models left, `models/training/NAME/{losses.csv,summary.json}` of
/// the folder above the program that has them (or of CLEARWAY_HOME), into `folder`, for the report's
/// train-test curves. Does nothing where nothing is shipped. Throws core::EnvironmentError when it cannot
/// write.
void copy_shipped_trainings(const std::filesystem::path& folder);

}  // namespace clearway::cli
