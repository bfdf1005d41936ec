#include "scenario/detail/library.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/near_file.hpp"
#include "core/shipped_files.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario {

namespace detail {

namespace {

constexpr const char* file_name = "scenario.toml";

/// Names of the scenarios in the current folder, written as `like` is: with `./` or without.
std::vector<std::string> scenarios_here(const std::string& like) {
    std::vector<std::string> names;
    std::error_code none;
    for (auto entry = std::filesystem::directory_iterator(".", none);
         !none && entry != std::filesystem::directory_iterator(); entry.increment(none)) {
        std::error_code unknown;  // such as a link that leads to itself
        if (std::filesystem::is_regular_file(entry->path() / file_name, unknown))
            names.push_back((like.starts_with("./") ? "./" : "") + entry->path().filename().string());
    }
    return names;
}

constexpr const char* what_is_one =
    "a name of `clearway list scenarios`, a folder with a scenario.toml, or a TOML file";

/// Whether a map or a file of SUMO's has such a name, of which the import makes a scenario.
bool is_imported(const std::filesystem::path& file) {
    constexpr std::array endings = {".osm", ".pbf", ".gz", ".bz2", ".xml", ".sumocfg"};
    return std::ranges::any_of(endings, [&](const char* ending) { return file.extension() == ending; });
}

void refuse_what_is_imported(const std::filesystem::path& file) {
    if (is_imported(file))
        throw core::InputError(
            {file.string(), "is not a scenario, but a file that one is made of", what_is_one,
             fmt::format("`clearway scenario import {} --name NAME` makes one", file.string())});
}

/// A text that can mean a file or folder alone, and that names none.
void refuse_missing_file(const std::filesystem::path& path) {
    if (path.empty()) throw core::InputError({"the scenario", "is an empty text", what_is_one, ""});
    const bool is_map = is_imported(path);
    std::error_code unknown;
    const bool is_path = is_map || path.extension() == ".toml" || path.has_parent_path();
    if (!is_path || std::filesystem::exists(path, unknown)) return;
    throw core::InputError(
        {path.string(), path.has_extension() ? "there is no such file" : "there is no such folder",
         what_is_one,
         core::did_you_mean_file(
             path, is_map ? "Of a map, `clearway scenario import FILE --name NAME` makes one" : "")});
}

}  // namespace

std::filesystem::path library_folder() {
    if (const auto one = core::shipped(std::filesystem::path("scenarios") / "merge" / file_name))
        return one->parent_path().parent_path();
    if (const char* home = std::getenv("CLEARWAY_HOME"); home != nullptr && *home != '\0')
        throw core::EnvironmentError(
            fmt::format("CLEARWAY_HOME is {}, which has no folder 'scenarios'", home));
    throw core::EnvironmentError(
        "no folder 'scenarios' or 'share/clearway/scenarios' above the program. Set CLEARWAY_HOME to the "
        "folder that holds Clearway's sources, or install Clearway again");
}

std::filesystem::path scenario_file(const std::string& name_or_path) {
    std::filesystem::path path(name_or_path);
    if (std::filesystem::is_regular_file(path / file_name)) path /= file_name;
    const bool is_file = std::filesystem::is_regular_file(path);
    if (is_file) refuse_what_is_imported(path);
    if (is_file && name_or_path.find('/') != std::string::npos) return path;
    const std::vector<std::string> names = list();
    if (std::find(names.begin(), names.end(), name_or_path) != names.end()) {
        const std::filesystem::path shipped = library_folder() / name_or_path;
        if (is_file && !std::filesystem::equivalent(path, shipped / file_name))
            throw core::InputError(
                core::Problem{name_or_path, "is a shipped scenario and stands in this folder too", "",
                              fmt::format("Say ./{} for the one here, {} for the shipped one", name_or_path,
                                          shipped.string())});
        return shipped / file_name;
    }
    if (is_file) return path;
    refuse_missing_file(path);
    std::vector<std::string> near = scenarios_here(name_or_path);
    near.insert(near.end(), names.begin(), names.end());
    throw core::InputError(core::Problem{
        name_or_path, "is neither a scenario, nor a folder with a scenario.toml, nor a file",
        core::listed(names) + ", a folder or a TOML file", core::did_you_mean(name_or_path, near)});
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') {
            result += '\\';
            result += letter;
        } else if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) {
            result += fmt::format("\\u{:04X}", static_cast<unsigned>(letter));
        } else {
            result += letter;
        }
    }
    return result + "\"";
}

}  // namespace detail

std::string newest(const std::string& name) {
    const std::string second = name + "_v2";
    return std::filesystem::is_regular_file(detail::library_folder() / second / detail::file_name) ? second
                                                                                                   : name;
}

std::vector<std::string> list() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(detail::library_folder()))
        if (std::filesystem::is_regular_file(entry.path() / detail::file_name))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace clearway::scenario
