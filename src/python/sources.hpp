#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace clearway::python {

/// The files that a part is made of: its own first; then, for a file in Python, those that it imports from
/// its own folder, and what they import from there. Python reads their imports and runs nothing of them. What
/// is imported from other folders or only while it runs (`importlib`), and files of data, are not among them.
/// Throws core::InputError, saying `where`, when Python cannot be started.
std::vector<std::filesystem::path> sources_of(const std::filesystem::path& file, const std::string& where);

/// Where a file of the user is now: at `file` or, where that does not have the hash, in the first of
/// `folders` that has a file of this name with it. Throws core::InputError, saying `where`, when none has: it
/// tells which files have another content.
std::filesystem::path located_file(const std::filesystem::path& file, const std::string& hash,
                                   const std::vector<std::filesystem::path>& folders,
                                   const std::string& where,
                                   const std::function<std::string(const std::filesystem::path&)>& hash_of);

/// Hash of the content of one file, or of the contents and places of several.
std::string hash_of(const std::vector<std::filesystem::path>& files);

}  // namespace clearway::python
