#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/ids.hpp"

namespace clearway::core {

inline constexpr std::uint32_t no_row = std::numeric_limits<std::uint32_t>::max();

/// Row in `sorted` of each of `keys`, both ascending; `no_row` where there is none.
inline void match_rows(const std::vector<VehicleKey>& keys, const std::vector<VehicleKey>& sorted,
                       std::vector<std::uint32_t>& rows) {
    rows.clear();
    std::uint32_t at = 0;
    for (const VehicleKey key : keys) {
        while (at < sorted.size() && sorted[at] < key)
            ++at;
        rows.push_back(at < sorted.size() && sorted[at] == key ? at : no_row);
    }
}

}  // namespace clearway::core
