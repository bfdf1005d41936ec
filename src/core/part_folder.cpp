#include "core/part_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/open_file.hpp"
#include "core/plain_files.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

namespace fs = std::filesystem;

/// The files and folders below `folder`, parents first, relative to it.
std::vector<fs::path> below(const fs::path& folder, const std::string& left_out) {
    require_plain_files(folder);
    std::vector<fs::path> paths;
    for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
         ++entry) {
        if (entry.depth() == 0 && entry->path().filename() == left_out) {
            entry.disable_recursion_pending();
            continue;
        }
        paths.push_back(fs::relative(entry->path(), folder));
    }
    std::ranges::sort(paths);
    return paths;
}

bool holds_the_same(const fs::path& source, const fs::path& target, const std::vector<fs::path>& paths) {
    return std::ranges::all_of(paths, [&](const fs::path& path) {
        const fs::path copy = target / path;
        if (fs::is_directory(source / path)) return fs::is_directory(copy);
        return fs::is_regular_file(copy) && fs::file_size(copy) == fs::file_size(source / path) &&
               content_hash(read_file(copy)) == content_hash(read_file(source / path));
    });
}

void flush_folders(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_directory()) flush_folder(entry.path());
    flush_folder(folder);
}

}  // namespace

PartFolder::PartFolder(fs::path target)
    : target_(std::move(target)),
      part_(target_.parent_path() /
            fmt::format(".{}.{}{}", target_.filename().string(), ::getpid(), part_ending)) {
    std::error_code ignored;
    fs::remove_all(part_, ignored);  // of a killed process that had this number
    make_folder(part_);
}

PartFolder::~PartFolder() {
    std::error_code ignored;
    fs::remove_all(part_, ignored);
}

bool PartFolder::put_in_place() {
    if (::rename(part_.c_str(), target_.c_str()) == 0) return true;
    if (errno == EEXIST || errno == ENOTEMPTY) return false;
    throw write_error(target_, errno);
}

void PartFolder::replace() {
    flush_folders(part_);
    std::error_code error;
    fs::remove_all(target_, error);
    if (error) throw write_error(target_, error.value());
    if (!put_in_place()) throw write_error(target_, EEXIST);
    flush_folder(target_.has_parent_path() ? target_.parent_path() : ".");
}

void copy_file(const fs::path& file, const fs::path& copy, Copying copying) {
    if (copying == Copying::links && ::link(file.c_str(), copy.c_str()) == 0) return;
    OpenFile source(file, O_NOFOLLOW);
    AtomicFile target(copy);
    source.read([&](std::string_view piece) { target.write(piece); });
    target.commit();
}

void copy_folder(const fs::path& source, const fs::path& target, const std::string& left_out) try {
    if (!fs::exists(source)) return;
    const std::vector<fs::path> paths = below(source, left_out);
    if (fs::exists(target) && holds_the_same(source, target, paths)) return;
    PartFolder part(target);
    for (const fs::path& path : paths) {
        if (fs::is_directory(source / path))
            make_folder(part.path() / path);
        else
            copy_file(source / path, part.path() / path, Copying::bytes);
    }
    part.replace();
} catch (const fs::filesystem_error& error) {
    throw EnvironmentError(
        fmt::format("{}: {}. {}", target.string(), error.what(), cure_of(error.code().value())));
}

}  // namespace clearway::core
