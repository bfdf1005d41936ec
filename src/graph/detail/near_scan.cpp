#include "graph/detail/near_scan.hpp"

#include <array>
#include <bit>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace clearway::graph::detail {

// Six parameters: a kernel's arguments stay in registers.
// NOLINTNEXTLINE(readability-function-size)
std::size_t scan_scalar(const ScanColumns& columns, std::size_t first, std::size_t last,
                        const ScanTarget& target, std::uint32_t* vehicles, float* squared_m2) {
    std::size_t count = 0;
    for (std::size_t place = first; place < last; ++place) {
        const float dx_m = columns.x_m[place] - target.x_m;
        const float dy_m = columns.y_m[place] - target.y_m;
        const float distance_m2 = dx_m * dx_m + dy_m * dy_m;
        if (!(distance_m2 < target.limit_m2) || (columns.class_bit[place] & target.allowed) == 0) continue;
        vehicles[count] = columns.vehicle[place];
        squared_m2[count] = distance_m2;
        ++count;
    }
    return count;
}

#if defined(__x86_64__)
namespace {

/// For each 8-bit mask, the order that moves the chosen lanes to the front.
constexpr auto packing_orders = [] {
    std::array<std::array<std::int32_t, 8>, 256> orders{};
    for (unsigned mask = 0; mask < 256; ++mask) {
        std::size_t next = 0;
        for (std::int32_t lane = 0; lane < 8; ++lane) {
            if ((mask >> lane & 1U) != 0) orders[mask][next++] = lane;
        }
    }
    return orders;
}();

__attribute__((target("avx2"))) __m256i load(const void* words) {
    return _mm256_loadu_si256(static_cast<const __m256i*>(words));
}

/// No fused multiply-add, on purpose: the sums must equal those of the scalar kernel.
// NOLINTNEXTLINE(readability-function-size)
__attribute__((target("avx2"))) std::size_t scan_avx2(const ScanColumns& columns, std::size_t first,
                                                      std::size_t last, const ScanTarget& target,
                                                      std::uint32_t* vehicles, float* squared_m2) {
    const __m256 x_m = _mm256_set1_ps(target.x_m);
    const __m256 y_m = _mm256_set1_ps(target.y_m);
    const __m256 limit_m2 = _mm256_set1_ps(target.limit_m2);
    const __m256i allowed = _mm256_set1_epi32(static_cast<std::int32_t>(target.allowed));
    std::size_t count = 0;
    for (std::size_t place = first; place < last; place += 8) {
        const __m256 dx_m = _mm256_sub_ps(_mm256_loadu_ps(columns.x_m + place), x_m);
        const __m256 dy_m = _mm256_sub_ps(_mm256_loadu_ps(columns.y_m + place), y_m);
        const __m256 distance_m2 = _mm256_add_ps(_mm256_mul_ps(dx_m, dx_m), _mm256_mul_ps(dy_m, dy_m));
        const __m256 near = _mm256_cmp_ps(distance_m2, limit_m2, _CMP_LT_OQ);
        const __m256i excluded = _mm256_cmpeq_epi32(
            _mm256_and_si256(load(columns.class_bit + place), allowed), _mm256_setzero_si256());
        auto mask =
            static_cast<unsigned>(_mm256_movemask_ps(_mm256_andnot_ps(_mm256_castsi256_ps(excluded), near)));
        if (last - place < 8) mask &= (1U << (last - place)) - 1U;
        const __m256i order = load(packing_orders[mask].data());
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(vehicles + count),
                            _mm256_permutevar8x32_epi32(load(columns.vehicle + place), order));
        _mm256_storeu_ps(squared_m2 + count, _mm256_permutevar8x32_ps(distance_m2, order));
        count += static_cast<std::size_t>(std::popcount(mask));
    }
    return count;
}

}  // namespace

NearScan fastest_scan() {
    return __builtin_cpu_supports("avx2") ? &scan_avx2 : &scan_scalar;
}
#else
NearScan fastest_scan() {
    return &scan_scalar;
}
#endif

}  // namespace clearway::graph::detail
