#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/verb.hpp"
#include "scenario/config.hpp"

namespace clearway::cli {

Action configure_init(CLI::App& app) {
    struct Arguments {
        std::string folder;
        std::string from = "intersection";
    };
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("folder", arguments->folder, "New or empty folder; its name becomes the scenario's")
        ->required()
        ->option_text("DIR (required)");
    app.add_option("--from", arguments->from, "Scenario to copy: a name, a folder or a file")
        ->option_text("SCENARIO [intersection]");
    return [arguments](const Invocation&) {
        scenario::init(arguments->folder, arguments->from);
        fmt::print("{}/scenario.toml written, a copy of {}. Edit it, then: clearway run {}\n",
                   arguments->folder, arguments->from, arguments->folder);
        return core::ExitCode::ok;
    };
}

}  // namespace clearway::cli
