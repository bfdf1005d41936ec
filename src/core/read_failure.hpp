#pragma once

#include <filesystem>
#include <string>

namespace clearway::core {

/// Says why a file could not be opened or read, with `reason` an `errno`. Throws InputError where another
/// path or other permissions help, and EnvironmentError where the machine failed: a device, too many open
/// files, no memory. What failed by the machine may succeed later, so a run is tried again.
[[noreturn]] void fail_to_read(const std::filesystem::path& file, int reason);

}  // namespace clearway::core
