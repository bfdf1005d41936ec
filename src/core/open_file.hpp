#pragma once

#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {

/// A file that is open for reading. Throws as fail_to_read does.
class OpenFile {
  public:
    /// `flags` are further ones of open(2), such as O_NOFOLLOW. A pipe or a device is refused: it may have no
    /// end. Those that a caller hands over, such as /dev/stdin, are read.
    explicit OpenFile(const std::filesystem::path& file, int flags = 0)
        : file_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | flags)) {
        if (descriptor_ < 0) fail_to_read(file, errno);
        struct stat status {};
        const int reason = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
        if (reason == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))) return;
        if (reason == 0 && is_handed_over()) {
            ::fcntl(descriptor_, F_SETFL, 0);  // waits for whoever writes
            return;
        }
        ::close(descriptor_);
        if (reason != 0) fail_to_read(file, reason);
        throw InputError({file.string(), "is neither a file nor a folder", "a file",
                          "Remove it, or put a copy of what it stands for in its place"});
    }
    ~OpenFile() { ::close(descriptor_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    /// Leaves out the first `bytes`.
    void skip(std::uintmax_t bytes) {
        if (::lseek(descriptor_, static_cast<off_t>(bytes), SEEK_SET) < 0) fail_to_read(file_, errno);
    }

    /// Calls `take` with one piece after another to the end.
    template <class Take>
    void read(const Take& take) {
        std::array<char, 1 << 16> piece{};
        for (;;) {
            const ssize_t count = ::read(descriptor_, piece.data(), piece.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail_to_read(file_, errno);
            if (count == 0) return;
            take(std::string_view(piece.data(), static_cast<std::size_t>(count)));
        }
    }

  private:
    bool is_handed_over() const {
        const std::string name = file_.string();
        return name.starts_with("/dev/std") || name.starts_with("/dev/fd/") || name.starts_with("/proc/") ||
               name == "/dev/null";
    }

    std::filesystem::path file_;
    int descriptor_;
};

}  // namespace clearway::core
