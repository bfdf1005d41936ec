#pragma once

#include <string>
#include <string_view>

namespace clearway::core {

/// Text made safe for HTML and SVG, in elements and in double-quoted attributes. Control characters other
/// than tab and newline become U+FFFD.
std::string escaped(std::string_view text);

}  // namespace clearway::core
