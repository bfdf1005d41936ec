#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.hpp"

namespace clearway::core {

/// The error to throw when `path` cannot be written: the system's reason (an errno value) and what to do.
EnvironmentError write_error(const std::filesystem::path& path, int reason);

/// A file that is written piece by piece and appears as a whole or not at all. The bytes go to a temporary
/// file beside it, which `commit` flushes and renames. Without `commit` the temporary file is removed. All
/// functions throw EnvironmentError naming the file (folder not writable, disk full).
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path file);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    /// The temporary file, for a library which writes to a path.
    const std::filesystem::path& aside() const { return aside_; }
    /// Puts the file in place of an earlier one. Nothing can be written afterwards.
    void commit();
    /// Likewise where nothing is there. False if there is something, which stays.
    bool commit_new();

  private:
    void finish();
    [[noreturn]] void fail();

    std::filesystem::path file_;
    std::filesystem::path aside_;
    int descriptor_ = -1;
};

}  // namespace clearway::core
