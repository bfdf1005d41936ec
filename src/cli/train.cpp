#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "campaign/programs.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"

namespace clearway::cli {

/// clearway-train parses its own arguments, so that this program does not need libtorch.
Action configure_train(CLI::App& app) {
    app.set_help_flag();  // clearway-train prints its own help
    app.prefix_command();
    CLI::App* const command = &app;
    return [command](const Invocation&) -> core::ExitCode {
        const std::string trainer = campaign::sister_program("clearway-train");
        if (!std::filesystem::exists(trainer))
            throw core::EnvironmentError(
                fmt::format("clearway-train is not built, because {}", campaign::why_no_trainer));
        campaign::become(trainer, command->remaining());
    };
}

}  // namespace clearway::cli
