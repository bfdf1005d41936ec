#pragma once

#include <string>
#include <string_view>

namespace clearway::view::detail {

/// The built page of page/: one script that may stand in a script element as it is.
std::string_view page_script();

/// Its SHA-256, 32 bytes, taken when the program was configured.
std::string page_script_sha256();

}  // namespace clearway::view::detail
