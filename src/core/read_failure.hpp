#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

#include "core/error.hpp"

namespace clearway::core {

/// Says why a file could not be opened or read, with `reason` an `errno`. Throws InputError where another
/// path or other permissions help, and EnvironmentError where the machine failed: a device, too many open
/// files, no memory. What failed by the machine may succeed later, so a run is tried again.
[[noreturn]] void fail_to_read(const std::filesystem::path& file, int reason);

/// What to do after a call on a path failed with `reason`, an `errno`: one sentence without its full stop.
const char* cure_of(int reason);

/// What to tell of a call that threw, on a path perhaps: bad input where only another path helps.
Error error_of(const std::system_error& fault);

/// Whether `reason`, an `errno`, is a failure of the machine that may pass.
bool is_of_machine(int reason);
/// Whether another program says in `words` that the machine failed, not that its input is wrong.
bool tells_of_machine(std::string_view words);

}  // namespace clearway::core
