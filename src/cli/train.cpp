#include <CLI/CLI.hpp>

#include "campaign/programs.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

/// clearway-train parses its own arguments, so that this program does not need libtorch.
Action configure_train(CLI::App& app) {
    app.set_help_flag();  // clearway-train prints its own help
    app.prefix_command();
    CLI::App* const command = &app;
    return [command](const Invocation&) -> core::ExitCode {
        campaign::become(campaign::sister_program("clearway-train"), command->remaining());
    };
}

}  // namespace clearway::cli
