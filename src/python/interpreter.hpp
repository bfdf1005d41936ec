#pragma once

#include <filesystem>
#include <string>

#include "core/process.hpp"

namespace clearway::python {

/// The Python that runs parts: CLEARWAY_PYTHON, or /usr/bin/python3.
std::string interpreter();

/// The folder that holds the package `clearway`: CLEARWAY_PACKAGE, or `python` of the tree. Throws
/// core::EnvironmentError when it is not there.
std::filesystem::path package_folder();

/// A Python with the package on its path, beside what PYTHONPATH names: `python3 -m MODULE ARGUMENTS`.
core::Command run_module(const std::string& module, const std::vector<std::string>& arguments);

}  // namespace clearway::python
