#pragma once

#include <cstddef>
#include <cstdint>

namespace clearway::graph::detail {

/// The vector kernel may read this many elements past the end of a range.
inline constexpr std::size_t scan_margin = 8;

/// Vehicles as columns. `class_bit` has one bit per class.
struct ScanColumns {
    const float* x_m;
    const float* y_m;
    const std::uint32_t* class_bit;
    const std::uint32_t* vehicle;
};

/// What a scan looks for: vehicles of a class in `allowed` whose squared distance is below `limit_m2`.
struct ScanTarget {
    float x_m;
    float y_m;
    float limit_m2;
    std::uint32_t allowed;
};

/// Writes the vehicles found in [first, last) and their squared distances, in order, and returns their
/// number. Both outputs have room for last - first + scan_margin elements.
using NearScan = std::size_t (*)(const ScanColumns& columns, std::size_t first, std::size_t last,
                                 const ScanTarget& target, std::uint32_t* vehicles, float* squared_m2);

std::size_t scan_scalar(const ScanColumns& columns, std::size_t first, std::size_t last,
                        const ScanTarget& target, std::uint32_t* vehicles, float* squared_m2);

/// The AVX2 kernel where the processor has it, else `scan_scalar`. Same results, bit for bit.
NearScan fastest_scan();

}  // namespace clearway::graph::detail
