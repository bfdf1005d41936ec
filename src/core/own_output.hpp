#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace clearway::core {

/// The one rule for what a verb writes into: it is new, empty, or what the verb itself has written. By what
/// does it know its own folders?
struct OwnFolder {
    const char* verb;                ///< `clearway export figures`.
    std::vector<const char*> marks;  ///< Names that only this verb puts there; any of them will do.
};

/// Throws InputError unless `folder` is missing, a file (making a folder there then fails), holds only hidden
/// names and leftovers, or has a mark; and as holds_only does.
void require_own(const std::filesystem::path& folder, const OwnFolder& own);
/// Likewise, and makes a folder that was missing or empty with its first mark, so that a call that is killed
/// early can be given again. Throws EnvironmentError when it cannot be written.
void claim(const std::filesystem::path& folder, const OwnFolder& own);

/// Throws EnvironmentError, as make_folder does, for a folder that cannot be made or written. Leaves nothing
/// there that was not there before, as a dry run must.
void require_writable(const std::filesystem::path& folder);

/// By what a verb knows its own files.
struct OwnFile {
    const char* what;       ///< `a page of clearway replay --view`.
    std::string_view mark;  ///< A text within the first `mark_reach` bytes of each.
};

/// Bytes at the beginning of a file in which its mark is looked for.
inline constexpr std::size_t mark_reach = 4096;

/// Writes a file that is new, empty or has the mark, as write_output does. Throws InputError for any other,
/// and leaves it.
void write_own(const std::filesystem::path& file, std::string_view content, const OwnFile& own);
/// Writes a file that is not there, also where somebody else makes one of that name meanwhile: that one stays
/// and InputError is thrown.
void write_new(const std::filesystem::path& file, std::string_view content);

}  // namespace clearway::core
