#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/files.hpp"
#include "core/number_range.hpp"
#include "metrics/link_quality.hpp"
#include "training/output_folder.hpp"
#include "training/outputs.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

// What all trainings share on the command line.

enum class Printing { epochs, closing_only, json };

struct CommonArguments {
    std::filesystem::path data;
    std::filesystem::path out;
    Printing printing = Printing::epochs;
};

/// From now on, after SIGINT or SIGTERM training ends after the current epoch and keeps what it has.
void watch_signals();

/// An option for every field of a configuration: `learning_rate` becomes `--learning-rate`, with its range
/// and default.
template <class Config>
std::vector<CLI::Option*> add_field_options(CLI::App& app, Config& config, const std::string& group) {
    std::vector<CLI::Option*> options;
    core::for_each_field<Config>([&](const auto& field) {
        std::string name = std::string("--") + field.name;
        std::ranges::replace(name, '_', '-');
        auto& member = config.*field.member;
        using Member = std::remove_reference_t<decltype(member)>;
        CLI::Option* option = nullptr;
        if constexpr (std::is_enum_v<Member>) {
            std::map<std::string, Member> choices;
            std::string words, chosen;
            for (const auto& [value, word] : spellings(Member{})) {
                choices.emplace(word, value);
                words += (words.empty() ? "" : "|") + std::string(word);
                if (value == member) chosen = word;
            }
            option = app.add_option_function<std::string>(
                            name, [&member, choices](const std::string& word) { member = choices.at(word); },
                            field.doc)
                         ->check(CLI::IsMember(choices))
                         ->option_text(fmt::format("{} [{}]", words, chosen));
        } else if constexpr (std::is_same_v<Member, bool>) {
            option =
                app.add_option(name, member, field.doc)->option_text(fmt::format("true|false [{}]", member));
        } else {
            option = app.add_option(name, member, field.doc)
                         ->check(core::NumberRange{field.minimum, field.maximum})
                         ->option_text(
                             fmt::format("NUMBER, {:g} to {:g} [{}]", field.minimum, field.maximum, member));
        }
        options.push_back(option->group(group));
    });
    return options;
}

/// The sample files, and the hash of the content of each. Throws core::InputError where two are the same.
template <class Read>
auto read_distinct(const std::vector<std::filesystem::path>& paths, const Read& read) {
    std::vector<decltype(read(paths.front()))> files;
    std::vector<std::string> hashes;
    for (const std::filesystem::path& path : paths) {
        files.push_back(read(path));
        if constexpr (requires { files.back().content_hash; }) {
            hashes.push_back(files.back().content_hash);
        } else {
            hashes.push_back(core::content_hash(core::read_file(path)));
        }
    }
    require_distinct(paths, hashes);
    return std::pair(std::move(files), std::move(hashes));
}

/// Three decimals, or `undefined`.
std::string figure(const std::optional<double>& value);
void print_quality(const std::string& label, const metrics::LinkQuality& quality);

/// Hooks that print a line for each of `rounds`, counted from 1, if `printing` is `Printing::epochs`. `round`
/// is what one is called.
TrainingHooks hooks_with_lines(Printing printing, std::uint32_t rounds, const char* round = "epoch");

/// Writes the files of a training; prints its summary with `--json`, otherwise `closing` where it was
/// measured, and the quality of each group. Returns the exit code; if it ended early, this is reported on
/// standard error.
core::ExitCode conclude(const CommonArguments& arguments, const OutputFolder& folder,
                        const TrainingResult& result, const Identity& identity, const std::string& closing);

/// A net that can be trained.
struct Net {
    const char* name;     ///< The predictor that it drives.
    const char* summary;  ///< A line for the list of nets, which is also the head of its help.
    const char* data;  ///< What `clearway links dataset SCENARIO --out DIR` needs beside to record its data.
    const char* results;  ///< The files that it writes.
    /// Declares its options and returns what trains it.
    std::function<core::ExitCode()> (*configure)(CLI::App& app, CommonArguments& arguments);
};
/// The learned repairs, the recommended one first.
std::span<const Net> repair_nets();
/// What only compares, and what repeats the dissertation.
std::span<const Net> comparison_nets();

}  // namespace clearway::training
