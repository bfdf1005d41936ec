#include "core/usage.hpp"

#include <algorithm>
#include <regex>
#include <sstream>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/terminal.hpp"

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

constexpr std::size_t description_column = 30;

/// One indented line of a help text.
std::string wrapped_line(const std::string& line) {
    if (line.size() <= help_columns) return line;
    if (line.starts_with("  clearway ")) return wrapped(line, 6, " \\");
    const std::size_t margin = line.find_first_not_of(' ');
    return wrapped(line, margin <= 2 ? description_column : margin);
}

/// The parser says `--seeds: Value x not in range 1 to 100`, whether x is a number or not.
std::string range_message(const std::string& text) {
    static const std::regex out_of_range("(.*): Value (.*) not in range (.*) to (.*)");
    static const std::regex too_often("(.*): At Most 1 required but received (.*)");
    std::smatch part;
    if (std::regex_match(text, part, too_often))
        return fmt::format("{}: is given {} times (allowed: once)", part[1].str(), part[2].str());
    if (!std::regex_match(text, part, out_of_range)) return text;
    const bool is_number = part[2].str().find_first_not_of("0123456789-") == std::string::npos;
    return fmt::format("{}: {} is {} (allowed: {} to {})", part[1].str(), part[2].str(),
                       is_number ? "out of range" : "no whole number", part[3].str(), part[4].str());
}

}  // namespace

HelpFormatter::HelpFormatter() {
    column_width(description_column);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    std::istringstream lines(CLI::Formatter::make_help(app, std::move(name), mode));
    std::string text;
    std::vector<std::string> paragraph;  // lines without an indent
    const auto finish_paragraph = [&] {
        const bool is_wide = std::ranges::any_of(
            paragraph, [](const std::string& line) { return line.size() > help_columns; });
        if (is_wide) {
            text += wrapped(fmt::format("{}", fmt::join(paragraph, " ")), 0) + '\n';
        } else {
            for (const std::string& line : paragraph)
                text += line + '\n';
        }
        paragraph.clear();
    };
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("Usage:")) finish_paragraph();  // it follows the description at once
        if (!line.empty() && line.front() != ' ') {
            paragraph.push_back(line);
            continue;
        }
        finish_paragraph();
        text += wrapped_line(line) + '\n';
    }
    finish_paragraph();
    return text;
}

std::string HelpFormatter::make_option_usage(const CLI::Option* option) const {
    const std::string words = make_option_name(option, true) + (option->get_expected_max() > 1 ? "..." : "");
    return option->get_required() ? words : "[" + words + "]";
}

std::string usage_message(const CLI::App& command, const std::string& name, const CLI::ParseError& error,
                          const std::vector<std::string>& words) {
    std::string text = fmt::format("{}: {}", name, range_message(error.what()));
    const std::vector<std::string> unknown = command.remaining();
    if (!unknown.empty()) {
        const std::string word = unknown.front().substr(0, unknown.front().find('='));
        std::vector<std::string> known = option_names(command);
        known.insert(known.end(), words.begin(), words.end());
        const bool takes_policy = core::contains(known, "--policy");
        const std::string hint =
            did_you_mean(word, known,
                         takes_policy && !word.starts_with('-')
                             ? fmt::format("Values follow their option: did you mean '--policy {}'?", word)
                             : "");
        text = fmt::format("{}: {} is not known here{}{}", name, word, hint.empty() ? "" : ". ", hint);
    }
    return fmt::format("{}\n`{} --help` says more.\n", text, name);
}

}  // namespace clearway::core
