#include "core/temporary_folder.hpp"

#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::core {

namespace {

EnvironmentError no_folder(const std::string& where) {
    return EnvironmentError(
        fmt::format("{}: cannot make a folder there. Set TMPDIR to a writable folder", where));
}

}  // namespace

std::filesystem::path temporary_place() {
    std::error_code error;
    std::filesystem::path place = std::filesystem::temp_directory_path(error);
    if (error) throw no_folder("TMPDIR");
    return place;
}

TemporaryFolder::TemporaryFolder() {
    const std::filesystem::path place = temporary_place();
    std::string pattern = (place / "clearway-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw no_folder(place.string());
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
