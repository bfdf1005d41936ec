#pragma once

#include <string>
#include <string_view>

namespace clearway::core {

/// Text as a cell of a CSV file (RFC 4180): quoted only where it must be.
std::string csv_text(std::string_view text);

}  // namespace clearway::core
