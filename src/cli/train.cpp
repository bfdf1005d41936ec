#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/verb.hpp"
#include "core/process.hpp"

namespace clearway::cli {
namespace {

/// Replaces this process with clearway-train, which parses its own arguments, so that this program does not
/// need libtorch.
core::ExitCode become_trainer(const std::vector<std::string>& arguments) {
    std::string program = core::program_folder() / "clearway-train";
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    ::execv(program.c_str(), pointers.data());
    throw core::EnvironmentError(fmt::format("{}: cannot be started: {}", program, std::strerror(errno)));
}

}  // namespace

Action configure_train(CLI::App& app) {
    app.set_help_flag();  // clearway-train prints its own help
    app.prefix_command();
    CLI::App* const command = &app;
    return [command](const Invocation&) { return become_trainer(command->remaining()); };
}

}  // namespace clearway::cli
