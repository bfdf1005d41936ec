#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace clearway::core {

/// The message for a command line that cannot be parsed: that of `error`, or the unknown word with the
/// nearest known one among the options of `command` and `words`. `name` is the command as the user typed it.
/// Two lines.
std::string usage_message(const CLI::App& command, const std::string& name, const CLI::ParseError& error,
                          const std::vector<std::string>& words = {});

}  // namespace clearway::core
