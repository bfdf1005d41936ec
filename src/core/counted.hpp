#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace clearway::core {

/// `1,234,567`.
std::string grouped(std::uint64_t count);

/// `1 run`, `1,234 runs`. For nouns whose plural takes an s.
std::string counted(std::uint64_t count, std::string_view noun);

}  // namespace clearway::core
