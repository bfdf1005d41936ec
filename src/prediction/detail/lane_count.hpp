#pragma once

#include <cstddef>

namespace clearway::prediction::detail {

/// Floats that one operation handles. Every row and every row of a weight matrix is padded with zeros to a
/// multiple.
inline constexpr std::size_t lane_count = 8;

constexpr std::size_t padded(std::size_t count) {
    return (count + lane_count - 1) / lane_count * lane_count;
}

}  // namespace clearway::prediction::detail
