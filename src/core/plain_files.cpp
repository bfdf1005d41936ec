#include "core/plain_files.hpp"

#include "core/error.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

namespace fs = std::filesystem;

void require_plain(const fs::path& path, const fs::file_status& status) {
    if (fs::is_regular_file(status) || fs::is_directory(status)) return;
    throw InputError({path.string(),
                      fs::is_symlink(status) ? "is a symbolic link" : "is neither a file nor a folder",
                      "files and folders", "Remove it, or put a copy of what it stands for in its place"});
}

}  // namespace

void require_plain_files(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (status.type() == fs::file_type::not_found) return;
    if (error) fail_to_read(path, error.value());
    require_plain(path, status);
    if (!fs::is_directory(status)) return;
    auto entry = fs::recursive_directory_iterator(path, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
        require_plain(entry->path(), entry->symlink_status());
    if (error) fail_to_read(path, error.value());
}

}  // namespace clearway::core
