#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace clearway::core {

/// A folder that is filled aside, as `.NAME.PID.clearway-part`, and appears at its place as a whole or not at
/// all. It is removed with this object unless it was put in place. All functions throw EnvironmentError
/// naming the folder.
class PartFolder {
  public:
    /// Makes the folder aside and its parents. `target` need not be there.
    explicit PartFolder(std::filesystem::path target);
    ~PartFolder();
    PartFolder(const PartFolder&) = delete;
    PartFolder& operator=(const PartFolder&) = delete;

    const std::filesystem::path& path() const { return part_; }
    /// Renames it, without flushing: that takes 8 ms, a short run 70 ms, and a rename lost in a power failure
    /// only means that a run is repeated. False when there is something at the target: rename(2) never
    /// replaces a folder that is not empty, on any file system.
    bool put_in_place();
    /// Flushes its files and folders, and its entry in the parent after renaming it over whatever is at the
    /// target, which is removed.
    void replace();

  private:
    std::filesystem::path target_;
    std::filesystem::path part_;
};

/// Whether files of a copy may share their bytes with the original.
enum class Copying : std::uint8_t { bytes, links };

/// Copies `file` to `copy`, which is not there. Bytes are flushed to the disk; a link has those of the
/// original, and is made only within a file system. Throws as fail_to_read and write_error do.
void copy_file(const std::filesystem::path& file, const std::filesystem::path& copy, Copying copying);

/// The one way to copy a folder: aside, flushed, renamed. `target` then has every file of `source` with the
/// same bytes, except what is in a folder `left_out` of its first level. A target that has them already is
/// left alone and one that has not, which a power failure left behind, is replaced. Nothing is done when
/// there is no `source`. Throws InputError for what is neither file nor folder, and as copy_file does.
void copy_folder(const std::filesystem::path& source, const std::filesystem::path& target,
                 const std::string& left_out = {});

}  // namespace clearway::core
