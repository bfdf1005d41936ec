#include "python/sources.hpp"

#include <csignal>
#include <set>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/read_failure.hpp"
#include "core/temporary_folder.hpp"
#include "python/interpreter.hpp"

namespace clearway::python {

namespace fs = std::filesystem;

std::vector<fs::path> sources_of(const fs::path& file, const std::string& where) {
    if (file.extension() != ".py") return {file};
    const core::TemporaryFolder folder;
    const fs::path said = folder.path() / "sources";
    const fs::path script = package_folder() / "clearway" / "_sources.py";
    // Alone and without site packages, it starts in some 15 ms.
    const core::Exit exit =
        core::run({.program = interpreter(),
                   .arguments = {"-I", "-S", "-W", "ignore", script.string(), file.string()},
                   .output = said});
    const std::string text = core::read_file(said);
    const bool tells_of_machine =
        core::tells_of_machine(text) || text.find("MemoryError") != std::string::npos;
    if (exit.signal == SIGKILL || (!exit.ok() && tells_of_machine))
        throw core::EnvironmentError(fmt::format(
            "{}: its imports could not be read ({}):\n{}\nThe machine failed: give the same command "
            "again",
            file.string(), exit.describe(), text));
    if (!exit.ok())
        throw core::InputError(
            {where,
             fmt::format("{}: Python ({}) ended with {} instead of reading its imports{}{}", file.string(),
                         interpreter(), exit.describe(), text.empty() ? "" : ":\n", text),
             "Python 3.11 or newer", "CLEARWAY_PYTHON names another Python"});
    std::vector<fs::path> files;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        files.emplace_back(line);
    return files;
}

fs::path located_file(const fs::path& file, const std::string& hash, const std::vector<fs::path>& folders,
                      const std::string& where, const std::function<std::string(const fs::path&)>& hash_of) {
    const std::string name = file.filename().string();
    std::vector<fs::path> places = {file};
    for (const fs::path& folder : folders)
        places.push_back(fs::absolute(folder / name).lexically_normal());
    std::vector<std::string> others;
    std::set<std::string> searched;
    for (const fs::path& place : places) {
        std::error_code unknown;
        if (!fs::is_regular_file(place, unknown)) {
            searched.insert(place.parent_path().string());
            continue;
        }
        if (hash_of(place) == hash) return place;
        others.push_back(place.string());
    }
    const std::string found =
        others.empty()
            ? fmt::format("{} is in none of {}", name, core::listed({searched.begin(), searched.end()}))
            : fmt::format("{} is not the file of the run: it, or a file that it imports, was changed",
                          core::listed(others));
    throw core::InputError(
        {where, found, "content hash " + hash,
         fmt::format("Copy the run's {} and the files that it imports from its folder beside "
                     "the run folder, or into the current folder",
                     name)});
}

std::string hash_of(const std::vector<fs::path>& files) {
    const std::string own = core::content_hash(core::read_file(files.front()));
    if (files.size() == 1) return own;
    std::string all = own;
    for (std::size_t i = 1; i < files.size(); ++i)
        all += fmt::format("\n{} {}", files[i].lexically_relative(files.front().parent_path()).string(),
                           core::content_hash(core::read_file(files[i])));
    return core::content_hash(all);
}

}  // namespace clearway::python
