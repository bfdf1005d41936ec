#include "core/own_output.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

namespace fs = std::filesystem;

bool has_mark(const fs::path& folder, const OwnFolder& own) {
    return std::ranges::any_of(own.marks, [&](const char* mark) {
        std::error_code unknown;
        return fs::exists(folder / mark, unknown);
    });
}

/// Also of an empty file.
bool has_mark(const fs::path& file, std::string_view mark) {
    std::ifstream in(file, std::ios::binary);
    if (!in) fail_to_read(file, errno);
    std::string head(mark_reach, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    if (in.bad()) fail_to_read(file, EIO);
    head.resize(static_cast<std::size_t>(in.gcount()));
    return head.empty() || head.find(mark) != std::string::npos;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& allowed) {
    throw InputError({file.string(), "is there already", allowed, "Choose another name, or remove it"});
}

}  // namespace

void require_own(const fs::path& folder, const OwnFolder& own) {
    std::error_code unknown;
    const fs::file_type found = fs::status(folder, unknown).type();
    // Where a file stands in the way, making the folder says so.
    if (found == fs::file_type::not_found || found == fs::file_type::regular) return;
    if (has_mark(folder, own) || is_absent_or_empty(folder)) return;
    throw InputError({"--out", fmt::format("{} holds something else", folder.string()),
                      fmt::format("a new or empty folder, or one of {}", own.verb), "Choose another folder"});
}

void claim(const fs::path& folder, const OwnFolder& own) {
    require_own(folder, own);
    make_folder(folder);
    if (!has_mark(folder, own)) write_output(folder / own.marks.front(), fmt::format("{}\n", own.verb));
}

void require_writable(const fs::path& folder) {
    std::vector<fs::path> missing;  // the innermost first
    std::error_code unknown;
    for (fs::path each = fs::absolute(folder).lexically_normal();
         each.has_relative_path() && fs::status(each, unknown).type() == fs::file_type::not_found;
         each = each.parent_path())
        if (each.has_filename()) missing.push_back(each);
    const auto remove_made = [&] {
        for (const fs::path& each : missing)
            fs::remove(each, unknown);  // Another process may have put something into it.
    };
    try {
        make_folder(folder);
    } catch (const EnvironmentError&) {
        remove_made();
        throw;
    }
    remove_made();
}

void write_own(const fs::path& file, std::string_view content, const OwnFile& own) {
    const std::string allowed = fmt::format("a new file, or {}", own.what);
    std::error_code unknown;
    const fs::file_status former = fs::status(file, unknown);
    if (fs::is_regular_file(former) && !has_mark(file, own.mark)) refuse(file, allowed);
    remove_leftovers_of(file);
    AtomicFile target(file);
    target.write(content);
    if (fs::exists(former)) return target.commit();
    if (!target.commit_new()) refuse(file, allowed);
}

void write_new(const fs::path& file, std::string_view content) {
    remove_leftovers_of(file);
    AtomicFile target(file);
    target.write(content);
    if (!target.commit_new()) refuse(file, "a new file");
}

}  // namespace clearway::core
