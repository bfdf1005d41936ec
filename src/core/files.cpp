#include "core/files.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "core/error.hpp"

namespace clearway::core {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* action) {
    const int reason = errno;
    const bool full = reason == ENOSPC || reason == EDQUOT;
    throw EnvironmentError(fmt::format("{}: cannot {}: {}. {}", file.string(), action, std::strerror(reason),
                                       full ? "Free some space there and give the same command again"
                                            : "Choose another place, or correct its rights"));
}

void write_all(int descriptor, std::string_view content, const std::filesystem::path& file) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file, "write");
        content.remove_prefix(static_cast<std::size_t>(written));
    }
}

}  // namespace

void write_atomically(const std::filesystem::path& file, std::string_view content) {
    const std::filesystem::path aside = file.string() + fmt::format(".{}.part", ::getpid());
    const int descriptor = ::open(aside.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0) fail(file, "write");
    try {
        write_all(descriptor, content, file);
        if (::fsync(descriptor) != 0) fail(file, "write");
    } catch (...) {
        ::close(descriptor);
        ::unlink(aside.c_str());
        throw;
    }
    ::close(descriptor);
    if (::rename(aside.c_str(), file.c_str()) != 0) {
        const int reason = errno;
        ::unlink(aside.c_str());
        errno = reason;
        fail(file, "write");
    }
}

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file)) {
        throw InputError({file.string(), "cannot be read", "", "Check that the file exists and is readable"});
    }
    std::ostringstream text;
    text << stream.rdbuf();
    return std::move(text).str();
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw EnvironmentError(
            fmt::format("{}: cannot make this folder: {}. Choose another place, or correct its rights",
                        folder.string(), error.message()));
    if (::access(folder.c_str(), W_OK) != 0) fail(folder, "write into this folder");
}

std::string content_hash(std::string_view bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace clearway::core
