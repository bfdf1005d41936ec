#include <memory>
#include <string>
#include <vector>

#include "campaign/programs.hpp"
#include "cli/detail/app.hpp"
#include "cli/verb.hpp"
#include "core/process.hpp"
#include "core/shipped_files.hpp"

namespace clearway::cli {
namespace {

struct PythonArguments {
    std::string virtual_environment;
    std::string folder;
    std::string python = "/usr/bin/python3";
};

/// Hands over to python/install.py, because a Python knows best where its packages are.
core::ExitCode install(const PythonArguments& arguments) {
    const auto installer = core::shipped("python/install.py");
    if (!installer)
        throw core::EnvironmentError(
            "python/install.py is not there. Install the package python3-clearway, or set CLEARWAY_HOME to "
            "Clearway's source tree");
    std::vector<std::string> words = {installer->string(), "--programs", core::program_folder().string(),
                                      "--version", CLEARWAY_VERSION};
    if (!arguments.virtual_environment.empty())
        words.insert(words.end(), {"--venv", arguments.virtual_environment});
    if (!arguments.folder.empty()) words.insert(words.end(), {"--to", arguments.folder});
    campaign::require_python(arguments.python);
    campaign::become(arguments.python, words);
}

}  // namespace

Action configure_python(App& app) {
    const auto arguments = std::make_shared<PythonArguments>();
    const Option venv = app.add_option("--venv", arguments->virtual_environment,
                                       "Virtual environment; made if it is not there")
                            .option_text("DIR [the user's site-packages]");
    app.add_option("--to", arguments->folder, "Folder for PYTHONPATH instead")
        .option_text("DIR [the user's site-packages]")
        .excludes(venv);
    app.add_option("--python", arguments->python, "The Python to install it for")
        .option_text("FILE [" + arguments->python + "]");
    return [arguments](const Invocation&) { return install(*arguments); };
}

}  // namespace clearway::cli
