#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenario_import/import.hpp"

namespace clearway::scenario_import::detail {

/// A program that an import starts in a child process.
struct Tool {
    std::string program;  ///< Looked up in PATH.
    std::vector<std::string> arguments;
    std::filesystem::path log;  ///< Receives both streams.
    std::string stage;          ///< What it does, for progress reports: `building the network`.
    std::string package;        ///< Debian package that contains it.
    /// Asked often while it runs; true ends it at once. May be empty.
    std::function<bool()> is_enough = {};
};

/// Runs a tool to its end, or until it has done enough, and reports progress. Returns false when it fails;
/// its log says why. Ends the child when `on_progress` throws. Throws core::EnvironmentError when it cannot
/// be started.
bool succeeds(const Tool& tool, const OnProgress& on_progress);

/// The lines of a failed tool's log that name errors, or its last lines. Throws core::EnvironmentError when
/// they say that the machine failed.
std::string complaint(const std::filesystem::path& log);

}  // namespace clearway::scenario_import::detail
