#pragma once

#include <filesystem>
#include <vector>

namespace clearway::scenario {

/// Throws core::InputError, with file and line, for elements of a network or of additional files that let
/// SUMO write a file, at any path, or read one that nobody has checked (`<include>`). Of a simulation that
/// Clearway starts: a run writes tables of its own.
void refuse_written_files(const std::filesystem::path& network,
                          const std::vector<std::filesystem::path>& additional);

}  // namespace clearway::scenario
