#pragma once

#include <random>
#include <string>
#include <string_view>

#include "fuzz/readers.hpp"

namespace clearway::fuzz {

/// One of the reader's seeds with one to four changes: bytes turned, put in, taken out, doubled or moved,
/// words of the reader put in, numbers exchanged, another seed's end. At most twice as long as the longest
/// seed, and 64 bytes.
std::string changed_seed(const Reader& reader, std::mt19937_64& draw);

}  // namespace clearway::fuzz
