#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/plan.hpp"

namespace clearway::cli {

/// What a program prints on both streams (its last 100 lines), or nothing when it cannot be started or fails.
/// `program` is a path or a name looked up in PATH.
std::optional<std::string> output_of(const std::string& program, const std::vector<std::string>& arguments);

/// Path of another of Clearway's programs, in the folder of this one.
std::string sister_program(const std::string& name);

/// Replaces this process with `program`, a path. Throws core::EnvironmentError when it cannot be started.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments);

/// Versions of Clearway and of the SUMO inside its worker, as the worker reports them. Throws
/// core::EnvironmentError when it cannot be started, usually because a shared library is missing.
study::Versions installed_versions();

}  // namespace clearway::cli
