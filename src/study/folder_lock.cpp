#include "study/folder_lock.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/read_failure.hpp"

namespace clearway::study {
namespace {

constexpr const char* lock_name = ".lock";

std::string host() {
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    return name.data();
}

std::string first_line(const std::filesystem::path& file) {
    const std::string text = core::read_file(file);
    return text.empty() ? "an unknown process" : text.substr(0, text.find('\n'));
}

/// A write lock on a whole file, held by the open file and not the process, so that forked children neither
/// hold nor lose it.
struct flock whole_file() {
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    return lock;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
    core::make_folder(folder);
    const std::filesystem::path file = folder / lock_name;
    descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (descriptor_ < 0)
        throw core::EnvironmentError(
            fmt::format("{}: {}. {}", file.string(), std::strerror(errno), core::cure_of(errno)));
    struct flock lock = whole_file();
    if (::fcntl(descriptor_, F_OFD_SETLK, &lock) != 0) {
        const int reason = errno;
        ::close(descriptor_);
        if (reason != EAGAIN && reason != EACCES)
            throw core::EnvironmentError(
                fmt::format("{}: cannot be locked: {}. Choose a folder on a file system with locks (a local "
                            "disk, NFS, Lustre mounted with `flock`)",
                            file.string(), std::strerror(reason)));
        throw core::EnvironmentError(
            fmt::format("{}: another command works in this folder ({}). Wait for its end, stop it, or choose "
                        "another folder with --out",
                        folder.string(), first_line(file)));
    }
    note(0);
}

void FolderLock::note(std::size_t ended_runs) const {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const std::string text =
        fmt::format("process {} on {}\n{}\n{}\n", ::getpid(), host(),
                    std::chrono::duration_cast<std::chrono::seconds>(now).count(), ended_runs);
    // Used only in messages: a full disk must not prevent resuming a study.
    if (::ftruncate(descriptor_, 0) == 0) (void)!::pwrite(descriptor_, text.data(), text.size(), 0);
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

std::optional<LockNote> holder_of(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / lock_name;
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return std::nullopt;
    struct flock lock = whole_file();
    const bool held = ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
    ::close(descriptor);
    if (!held) return std::nullopt;
    LockNote note;
    std::istringstream lines(core::read_file(file));
    std::getline(lines, note.holder);
    lines >> note.started_unix_s >> note.ended_runs;
    return note;
}

}  // namespace clearway::study
