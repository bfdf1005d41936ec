#include "core/files.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"
#include "core/running_hash.hpp"

namespace clearway::core {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* action) {
    const int reason = errno;
    throw EnvironmentError(
        fmt::format("{}: cannot {}: {}. {}", file.string(), action, std::strerror(reason), cure_of(reason)));
}

}  // namespace

void write_atomically(const std::filesystem::path& file, std::string_view content) {
    AtomicFile target(file);
    target.write(content);
    target.commit();
}

void flush_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) fail(folder, "open this folder");
    const bool failed = ::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP;
    const int reason = errno;
    ::close(descriptor);
    errno = reason;
    if (failed) fail(folder, "write into this folder");
}

std::string read_file(const std::filesystem::path& file) {
    OpenFile open(file);
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);  // a file with holes can have any
    const std::uintmax_t most = static_cast<std::uintmax_t>(::sysconf(_SC_PHYS_PAGES)) *
                                static_cast<std::uintmax_t>(::sysconf(_SC_PAGESIZE)) / 2;
    if (!unknown && bytes > most)
        throw InputError({file.string(), fmt::format("has {} MiB", bytes >> 20),
                          fmt::format("at most {} MiB, half of this machine's memory", most >> 20),
                          "Check that it is the right file"});
    std::string text;
    open.read([&](std::string_view piece) { text += piece; });
    return text;
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw write_error(folder, error.value());
    if (::access(folder.c_str(), W_OK) != 0) fail(folder, "write into this folder");
}

std::string content_hash(std::string_view bytes) {
    RunningHash hash;
    hash.add(bytes);
    return hash.digest();
}

}  // namespace clearway::core
