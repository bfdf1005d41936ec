#include "python/interpreter.hpp"

#include <cstdlib>

#include "core/error.hpp"
#include "core/shipped_files.hpp"

namespace clearway::python {
namespace {

std::string setting_of(const char* name, const std::string& usual) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != '\0' ? value : usual;
}

}  // namespace

std::string interpreter() {
    return setting_of("CLEARWAY_PYTHON", "/usr/bin/python3");
}

std::filesystem::path package_folder() {
    const std::string given = setting_of("CLEARWAY_PACKAGE", "");
    if (!given.empty()) return given;
    const auto host = core::shipped("python/clearway/_host.py");
    if (!host)
        throw core::EnvironmentError(
            "python/clearway is not there, and parts in Python need it. Install the package "
            "python3-clearway, or set CLEARWAY_HOME to Clearway's source tree");
    return host->parent_path().parent_path();
}

core::Command run_module(const std::string& module, const std::vector<std::string>& arguments) {
    std::string path = package_folder().string();
    const std::string before = setting_of("PYTHONPATH", "");
    if (!before.empty()) path += ":" + before;
    core::Command command{
        .program = interpreter(),
        .arguments = {"-P", "-m", module},  // no file of the user's folder hides a module of Python's
        .environment = {{"PYTHONPATH", path},
                        {"PYTHONHASHSEED", "0"}}};  // sets of words in one order in every run
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    return command;
}

}  // namespace clearway::python
