#pragma once

#include <string>

namespace clearway::report::detail {

/// A drawing of the page, one `<svg>` element with a view box, as a file of its own: with a size, a style
/// sheet and white paper. A picture with a style of its own keeps it.
std::string standalone(const std::string& drawing);

}  // namespace clearway::report::detail
