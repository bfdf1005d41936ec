#pragma once

#include <immintrin.h>

namespace clearway::prediction::detail {
namespace {

/// Eight floats handled at once. Internal to each file: only those compiled with -mavx2 may include this.
struct Avx2Lanes {
    __m256 value;

    static Avx2Lanes all(float number) { return {_mm256_set1_ps(number)}; }
    static Avx2Lanes load(const float* from) { return {_mm256_loadu_ps(from)}; }
    void store(float* to) const { _mm256_storeu_ps(to, value); }
    Avx2Lanes operator+(Avx2Lanes other) const { return {_mm256_add_ps(value, other.value)}; }
    Avx2Lanes operator*(Avx2Lanes other) const { return {_mm256_mul_ps(value, other.value)}; }
    Avx2Lanes operator/(Avx2Lanes other) const { return {_mm256_div_ps(value, other.value)}; }
    Avx2Lanes magnitude() const { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0F), value)}; }
    Avx2Lanes at_least_zero() const { return {_mm256_max_ps(value, _mm256_setzero_ps())}; }
};

}  // namespace
}  // namespace clearway::prediction::detail
