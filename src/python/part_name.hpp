#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::python {

/// A part of a condition that is code of the user: `my_policy.py:Yield`, a class of a file in Python, or
/// `net.pt`, a TorchScript module. Once resolved, it is absolute and ends in the hash of what it is made of
/// (`sources_of`), `/home/me/my_policy.py:Yield@3f...`, so that a changed file makes another condition.
struct PartName {
    std::filesystem::path file;
    std::string object;  ///< The class; empty for TorchScript.
    std::string hash;    ///< Of its files; empty before it is resolved.

    bool operator==(const PartName&) const = default;
};

/// Nothing when the word names no code of the user.
std::optional<PartName> part_name_from(std::string_view word);
std::string to_text(const PartName& name);

/// The word with an absolute file and the hash; other words as they are. A relative file is below `folder`.
/// Throws core::InputError, saying `where`, for a file that is not there, and for one whose content does not
/// have the hash that the word states.
std::string resolved(const std::string& word, const std::filesystem::path& folder, const std::string& where);

/// A resolved word with the file where it is now: its own place or, where that does not hold it, the first of
/// `folders` with a file of this name; the content has the hash that the word states. Other words as they
/// are. Throws core::InputError, saying `where`, when no place has it.
std::string located(const std::string& word, const std::vector<std::filesystem::path>& folders,
                    const std::string& where);

/// What leases, folders and tables call the part: the class, or the file's stem; other words as they are.
std::string short_name(std::string_view word);

}  // namespace clearway::python
