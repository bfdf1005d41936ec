#pragma once

#include <filesystem>

namespace clearway::core {

/// A folder that goes, with all it holds, when this object does.
class TemporaryFolder {
  public:
    /// A new folder among the system's temporary ones. Throws EnvironmentError when none can be made there.
    TemporaryFolder();
    /// `folder` itself, made with its parents where it is not there. Throws EnvironmentError as make_folder.
    explicit TemporaryFolder(std::filesystem::path folder);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace clearway::core
