#pragma once

#include <functional>
#include <string>

#include "core/error.hpp"

namespace clearway::core {

/// What `act` returns or, where it throws, the exit code of the error, which stands on standard error as
/// `NAME: message`. Standard output that cannot be written is such an error. Standard error may be on the
/// same full disk, so nothing is thrown where it cannot be written. `of_bug` is the code of an exception that
/// nobody made a message of.
ExitCode end_of(const std::string& name, const std::function<ExitCode()>& act,
                ExitCode of_bug = ExitCode::environment);

}  // namespace clearway::core
