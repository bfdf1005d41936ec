#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace clearway::core {

/// What standard error shows about a command line that cannot be parsed: the message of `error`, or the word
/// that is not known with the nearest one, among the options of `command` and `words`. `name` is what the
/// user calls the command. Two lines.
std::string usage_message(const CLI::App& command, const std::string& name, const CLI::ParseError& error,
                          const std::vector<std::string>& words = {});

}  // namespace clearway::core
