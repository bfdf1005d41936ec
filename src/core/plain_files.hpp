#pragma once

#include <filesystem>

namespace clearway::core {

/// Throws InputError, naming it, when `path` or something below it is neither a file nor a folder: a symbolic
/// link, which may lead anywhere or in circles, a pipe or a device. A missing path is none.
void require_plain_files(const std::filesystem::path& path);

}  // namespace clearway::core
