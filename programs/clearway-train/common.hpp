#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
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
#include "samples/repair_sample.hpp"
#include "training/output_folder.hpp"
#include "training/outputs.hpp"
#include "training/repair_scores.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

// What all trainings share on the command line.

enum class Printing { epochs, closing_only, json };

struct CommonArguments {
    std::filesystem::path data;
    std::filesystem::path out;
    Printing printing = Printing::epochs;
};

/// Whether SIGINT or SIGTERM was received. Training then ends after the current epoch and keeps what it has.
bool stop_requested();

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

/// `--data` and `--out` with their descriptions.
void add_folder_options(CLI::App& app, CommonArguments& arguments, const char* data_doc, const char* out_doc);
inline constexpr const char* repair_data_doc = "Data set of `clearway dataset --samples --net graphsage`";

/// `--quiet` and `--json`.
void add_printing_options(CLI::App& app, Printing& printing);

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

/// The data of the improved net, and the hash of their content.
struct RepairData {
    std::vector<samples::RepairSampleFile> files;
    std::string hash;
};
/// Throws core::InputError.
RepairData read_repair_data(const std::filesystem::path& folder);

/// Three decimals, or `undefined`.
std::string figure(const std::optional<double>& value);
void print_quality(const std::string& label, const metrics::LinkQuality& quality);

/// Hooks that print a line for each of `rounds`, counted from 1, if `printing` is `Printing::epochs`. `round`
/// is what one is called.
TrainingHooks hooks_with_lines(Printing printing, std::uint32_t rounds, const char* round = "epoch");

void print_json(const nlohmann::ordered_json& summary);
/// The summary for `--json`; otherwise, if it was measured, what was `kept` and the quality of each group.
void print_result(Printing printing, const RepairTraining& result, const nlohmann::ordered_json& summary,
                  const std::string& kept);

/// The exit code of a training. If it ended early, this is reported on standard error. `rounds` is the number
/// of rounds that it ran, including one that diverged, and `round` what one is called.
core::ExitCode exit_code_for(const OutputFolder& folder, Outcome outcome, std::size_t rounds, bool has_model,
                             const char* round = "epoch");

/// Parses the command line and trains. Returns the program's exit code. Throws core::Error.
int parse_and_train(CLI::App& app, int argument_count, char** argument_values,
                    const std::function<core::ExitCode()>& train);

/// `clearway train graphsage`.
inline constexpr const char* graphsage_word = "graphsage";
int run_graphsage(int argument_count, char** argument_values);

/// `clearway train gradient_boosting`.
inline constexpr const char* gradient_boosting_word = "gradient_boosting";
int run_gradient_boosting(int argument_count, char** argument_values);

}  // namespace clearway::training
