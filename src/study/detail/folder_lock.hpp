#pragma once

#include <filesystem>

namespace clearway::study::detail {

/// One study at a time in a run folder. Held while this object lives; the system gives it back when the
/// process dies, however it dies.
class FolderLock {
  public:
    /// Throws core::EnvironmentError, naming the other process, when the folder is taken or not writable.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int descriptor_;
};

}  // namespace clearway::study::detail
