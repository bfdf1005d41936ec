#include "core/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

/// A device or a pipe would be replaced by the new file. A folder cannot be.
void require_file(const std::filesystem::path& path) {
    std::error_code unknown;
    const std::filesystem::file_status status = std::filesystem::status(path, unknown);
    if (std::filesystem::is_other(status))
        throw EnvironmentError(
            fmt::format("{}: cannot write: it is not a file. Choose another place", path.string()));
}

}  // namespace

EnvironmentError write_error(const std::filesystem::path& path, int reason) {
    return EnvironmentError(
        fmt::format("{}: cannot write: {}. {}", path.string(), std::strerror(reason), cure_of(reason)));
}

AtomicFile::AtomicFile(std::filesystem::path file)
    : file_(std::move(file)), aside_(file_.string() + fmt::format(".{}{}", ::getpid(), part_ending)) {
    require_file(file_);
    descriptor_ = ::open(aside_.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0) fail();
}

AtomicFile::~AtomicFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(aside_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail();
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit() {
    if (::fsync(descriptor_) != 0) fail();
    if (::rename(aside_.c_str(), file_.c_str()) != 0) fail();
    finish();
}

bool AtomicFile::commit_new() {
    if (::fsync(descriptor_) != 0) fail();
    if (::renameat2(AT_FDCWD, aside_.c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE) != 0) {
        // Some file systems, such as NFS, have no such renaming. Their links do not replace either.
        const bool is_unknown = errno == EINVAL || errno == ENOSYS;
        if (is_unknown && ::link(aside_.c_str(), file_.c_str()) == 0) {
            ::unlink(aside_.c_str());
        } else {
            if (errno == EEXIST) return false;
            fail();
        }
    }
    finish();
    return true;
}

void AtomicFile::finish() {
    ::close(std::exchange(descriptor_, -1));
    flush_folder(file_.has_parent_path() ? file_.parent_path() : ".");
}

void AtomicFile::fail() {
    throw write_error(file_, errno);
}

}  // namespace clearway::core
