#pragma once

#include <filesystem>
#include <string>

namespace clearway::core {

/// Makes a new folder `PLACE/PREFIXpid-XXXXXX` for this process, which only its user can enter, and its
/// parents. First removes those of the same prefix whose process is gone: one that was killed (SIGKILL) could
/// not do it itself. Numbers of processes are those of this machine; a folder whose number another process
/// has by now stays. Throws EnvironmentError when it cannot be made.
std::filesystem::path process_folder(const std::filesystem::path& place, const std::string& prefix);

/// The system's temporary folder, or TMPDIR. Throws EnvironmentError when there is none.
std::filesystem::path temporary_place();

/// A folder that is removed with its contents when this object is destroyed.
class TemporaryFolder {
  public:
    /// A new folder in the system's temporary folder, named after this process as those of process_folder:
    /// what a killed process left goes when the next one is made. Throws EnvironmentError when it cannot be
    /// made.
    TemporaryFolder();
    /// Takes over `folder`, which is made with its parents if missing. Throws as make_folder does.
    explicit TemporaryFolder(std::filesystem::path folder);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace clearway::core
