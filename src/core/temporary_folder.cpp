#include "core/temporary_folder.hpp"

#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::core {

TemporaryFolder::TemporaryFolder() {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::temp_directory_path(error);
    std::string pattern = (place / "clearway-XXXXXX").string();
    if (error || ::mkdtemp(pattern.data()) == nullptr)
        throw EnvironmentError(fmt::format("{}: cannot make a folder there. Set TMPDIR to a writable folder",
                                           error ? "TMPDIR" : place.string()));
    path_ = pattern;
}

TemporaryFolder::TemporaryFolder(std::filesystem::path folder) : path_(std::move(folder)) {
    make_folder(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace clearway::core
