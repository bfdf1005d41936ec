#pragma once

#include <array>
#include <cerrno>
#include <filesystem>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "core/read_failure.hpp"

namespace clearway::core {

/// A file that is open for reading. Throws as fail_to_read does.
class OpenFile {
  public:
    /// `flags` are further ones of open(2), such as O_NOFOLLOW.
    explicit OpenFile(const std::filesystem::path& file, int flags = 0)
        : file_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | flags)) {
        if (descriptor_ < 0) fail_to_read(file, errno);
    }
    ~OpenFile() { ::close(descriptor_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

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
    std::filesystem::path file_;
    int descriptor_;
};

}  // namespace clearway::core
