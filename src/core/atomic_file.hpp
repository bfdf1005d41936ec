#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.hpp"

namespace clearway::core {

/// What to throw where `path` could not be written, with the system's reason (errno) and its cure.
EnvironmentError write_error(const std::filesystem::path& path, int reason);

/// A file that is written piece by piece and is there as a whole or not at all: written aside, and after
/// `commit` flushed to the disk and renamed, name and all. Without it, nothing is left. All functions throw
/// EnvironmentError naming the file (folder not writable, disk full).
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path file);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    /// Where the bytes are until `commit`, for a library that writes a file by its name.
    const std::filesystem::path& aside() const { return aside_; }
    /// Replaces an earlier file of the name. Nothing can be written afterwards.
    void commit();

  private:
    [[noreturn]] void fail();

    std::filesystem::path file_;
    std::filesystem::path aside_;
    int descriptor_ = -1;
};

/// Removes what an AtomicFile in `folder` left half written because its process was killed. Files of
/// processes that are still there stay.
void remove_abandoned_parts(const std::filesystem::path& folder);

}  // namespace clearway::core
