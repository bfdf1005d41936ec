#pragma once

#include <cstdint>

namespace clearway::campaign {

/// How results are printed on standard output.
enum class Printing : std::uint8_t { text, json };

}  // namespace clearway::campaign
