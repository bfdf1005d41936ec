#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>

namespace clearway::core {

/// The message for a command line that cannot be parsed: that of `error`, or the unknown word with the
/// nearest known one among the options of `command` and `words`. `name` is the command as the user typed it.
/// Two lines.
std::string usage_message(const CLI::App& command, const std::string& name, const CLI::ParseError& error,
                          const std::vector<std::string>& words = {});

/// Writes help within `help_columns`: descriptions go on below themselves, paragraphs are filled again, and
/// long example commands are continued with a backslash.
class HelpFormatter : public CLI::Formatter {
  public:
    HelpFormatter();
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    /// A positional argument in the line of usage: `folder`, `[table]`, `files...`.
    std::string make_option_usage(const CLI::Option* option) const override;
};

}  // namespace clearway::core
