#include "core/temporary_folder.hpp"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"

namespace clearway::core {
namespace {

constexpr const char* usual_prefix = "clearway-";

/// The process that a folder is named after; nothing for other names.
std::optional<pid_t> process_of(const std::string& name, const std::string& prefix) {
    if (!name.starts_with(prefix)) return std::nullopt;
    const char* const begin = name.data() + prefix.size();
    const char* const end = name.data() + name.size();
    pid_t process = 0;
    const auto [rest, error] = std::from_chars(begin, end, process);
    if (error != std::errc{} || rest == end || *rest != '-' || process <= 0) return std::nullopt;
    return process;
}

void remove_left_behind(const std::filesystem::path& place, const std::string& prefix) {
    std::error_code ignored;
    std::vector<std::filesystem::path> left;
    for (const auto& entry : std::filesystem::directory_iterator(place, ignored)) {
        const std::optional<pid_t> process = process_of(entry.path().filename().string(), prefix);
        if (process && is_gone(*process)) left.push_back(entry.path());
    }
    for (const std::filesystem::path& folder : left)
        std::filesystem::remove_all(folder, ignored);
}

EnvironmentError no_folder(const std::string& where, int reason) {
    return EnvironmentError(
        fmt::format("{}: cannot make a folder there: {}. Set TMPDIR to a writable folder, "
                    "or give the same command again if the machine failed",
                    where, std::strerror(reason)));
}

}  // namespace

std::filesystem::path process_folder(const std::filesystem::path& place, const std::string& prefix) {
    make_folder(place);
    remove_left_behind(place, prefix);
    std::string pattern = (place / fmt::format("{}{}-XXXXXX", prefix, ::getpid())).string();
    if (::mkdtemp(pattern.data()) == nullptr) throw write_error(place, errno);
    return pattern;
}

std::filesystem::path temporary_place() {
    std::error_code error;
    std::filesystem::path place = std::filesystem::temp_directory_path(error);
    if (error) throw no_folder("TMPDIR", error.value());
    return place;
}

TemporaryFolder::TemporaryFolder() {
    const std::filesystem::path place = temporary_place();
    remove_left_behind(place, usual_prefix);
    std::string pattern = (place / fmt::format("{}{}-XXXXXX", usual_prefix, ::getpid())).string();
    if (::mkdtemp(pattern.data()) == nullptr) throw no_folder(place.string(), errno);
    path_ = pattern;
}

TemporaryFolder::TemporaryFolder(std::filesystem::path folder) : path_(std::move(folder)) {
    make_folder(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code failed;
    std::filesystem::remove_all(path_, failed);
    if (failed) std::filesystem::remove_all(path_, failed);  // a failure of the machine may pass
}

}  // namespace clearway::core
