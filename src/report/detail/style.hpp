#pragma once

#include <string>

namespace clearway::report::detail {

/// The style sheet of a page, for light and dark screens and for print.
std::string page_style();

/// The style sheet of a drawing that stands alone, on white paper. Without custom properties, which not every
/// program that reads SVG knows.
std::string drawing_style();

}  // namespace clearway::report::detail
