#include "core/shipped_files.hpp"

#include <cstdlib>

#include "core/process.hpp"

namespace clearway::core {

std::optional<std::filesystem::path> shipped(const std::filesystem::path& name) {
    if (const char* const home = std::getenv("CLEARWAY_HOME"); home != nullptr && *home != '\0') {
        const std::filesystem::path path = home / name;
        return std::filesystem::exists(path) ? std::optional(path) : std::nullopt;
    }
    for (std::filesystem::path folder = program_folder();; folder = folder.parent_path()) {
        for (const std::filesystem::path& path : {folder / name, folder / "share" / "clearway" / name})
            if (std::filesystem::exists(path)) return path;
        if (!folder.has_relative_path()) return std::nullopt;
    }
}

}  // namespace clearway::core
