// Compiled with -mavx2 (see CMakeLists.txt); reached only after best_kernel() has asked the processor.
#include <immintrin.h>

#include "prediction/detail/graphsage_kernel.hpp"

namespace clearway::prediction::detail {
namespace {

struct Avx2Lanes {
    __m256 value;

    static Avx2Lanes all(float number) { return {_mm256_set1_ps(number)}; }
    static Avx2Lanes load(const float* from) { return {_mm256_loadu_ps(from)}; }
    void store(float* to) const { _mm256_storeu_ps(to, value); }
    Avx2Lanes operator+(Avx2Lanes other) const { return {_mm256_add_ps(value, other.value)}; }
    Avx2Lanes operator*(Avx2Lanes other) const { return {_mm256_mul_ps(value, other.value)}; }
    Avx2Lanes operator/(Avx2Lanes other) const { return {_mm256_div_ps(value, other.value)}; }
    Avx2Lanes at_least_zero() const { return {_mm256_max_ps(value, _mm256_setzero_ps())}; }
};

}  // namespace

void convolve_avx2(const ConvolutionTask& task) {
    convolve<Avx2Lanes>(task);
}
void decode_avx2(const DecoderTask& task) {
    decode<Avx2Lanes>(task);
}

}  // namespace clearway::prediction::detail
