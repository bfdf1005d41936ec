#include "core/usage.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::core {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

/// `--dens` -> `, did you mean --dense?`
std::string hint(const std::string& word, const std::vector<std::string>& known) {
    const std::string near = core::nearest(word, known);
    return near.empty() ? "" : fmt::format(", did you mean {}?", near);
}

}  // namespace

std::string usage_message(const CLI::App& command, const std::string& name, const CLI::ParseError& error,
                          const std::vector<std::string>& words) {
    std::string text = fmt::format("{}: {}", name, error.what());
    const std::vector<std::string> unknown = command.remaining();
    if (!unknown.empty()) {
        const std::string word = unknown.front().substr(0, unknown.front().find('='));
        std::vector<std::string> known = option_names(command);
        known.insert(known.end(), words.begin(), words.end());
        text = fmt::format("{}: {} is not known here{}", name, word, hint(word, known));
    }
    return fmt::format("{}\n`{} --help` says more.\n", text, name);
}

}  // namespace clearway::core
