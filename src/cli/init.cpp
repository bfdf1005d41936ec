#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/detail/app.hpp"
#include "cli/verb.hpp"
#include "core/process.hpp"
#include "scenario/config.hpp"

namespace clearway::cli {

Action configure_init(App& app) {
    struct InitArguments {
        std::string folder;
        std::string from = "intersection";
    };
    const auto arguments = std::make_shared<InitArguments>();
    app.add_option("folder", arguments->folder, "New or empty folder; its name becomes the scenario's")
        .required()
        .option_text("DIR (required)");
    app.add_option("--from", arguments->from, "Scenario to copy: a name, a folder or a file")
        .option_text("SCENARIO [intersection]");
    return [arguments](const Invocation&) {
        scenario::init(arguments->folder, arguments->from);
        // A bare name could be that of a scenario shipped with Clearway.
        const std::filesystem::path folder = arguments->folder;
        const std::string scenario =
            folder.is_absolute() ? folder.string() : "./" + folder.lexically_normal().string();
        fmt::print("{} written, a copy of {}. Edit it, then:\n  {}\n", (folder / "scenario.toml").string(),
                   arguments->from, core::shell_text({"clearway", "run", scenario}));
        return core::ExitCode::ok;
    };
}

}  // namespace clearway::cli
