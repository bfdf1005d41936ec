#pragma once

#include <exception>
#include <functional>
#include <string>

#include "core/error.hpp"

namespace clearway::core {

/// `NAME: message` on standard error. Throws nothing: that may be on a full disk.
void complain(const std::string& name, const std::exception& error);

/// What `act` returns or, where it throws, the exit code of the error, which stands on standard error as
/// `NAME: message`. Standard output that cannot be written is such an error. `of_bug` is the code of an
/// exception that is neither an Error nor the machine's (std::system_error, std::bad_alloc).
ExitCode end_of(const std::string& name, const std::function<ExitCode()>& act,
                ExitCode of_bug = ExitCode::environment);

}  // namespace clearway::core
