#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace clearway::study {

/// Allows one study at a time in a folder, or one recording of data sets. Held while this object lives; the
/// system releases it when the process dies, however it dies. Leaves a file there: ask first whether the
/// folder is ours (results::Store::refuse_others).
class FolderLock {
  public:
    /// Throws core::EnvironmentError when the folder is taken (naming the other process), not writable, or on
    /// a file system without locks.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Notes, for `holder_of`, how many runs had ended when the work began.
    void note(std::size_t ended_runs) const;

  private:
    int descriptor_;
};

/// What a FolderLock tells other processes.
struct LockNote {
    std::string holder;           ///< `process 4711 on host`.
    double started_unix_s = 0.0;  ///< When it was taken, by the clock of that host.
    std::size_t ended_runs = 0;   ///< Runs that had ended then.
};
/// The note of the lock that a process holds on `folder`; empty when none does. Does not disturb the lock.
std::optional<LockNote> holder_of(const std::filesystem::path& folder);

}  // namespace clearway::study
