#include "core/process_folder.hpp"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::core {
namespace {

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

bool is_gone(pid_t process) {
    return ::kill(process, 0) != 0 && errno == ESRCH;
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

}  // namespace

std::filesystem::path process_folder(const std::filesystem::path& place, const std::string& prefix) {
    make_folder(place);
    remove_left_behind(place, prefix);
    std::string pattern = (place / fmt::format("{}{}-XXXXXX", prefix, ::getpid())).string();
    if (::mkdtemp(pattern.data()) == nullptr)
        throw EnvironmentError(
            fmt::format("{}: cannot make a folder there: {}", place.string(), std::strerror(errno)));
    return pattern;
}

}  // namespace clearway::core
