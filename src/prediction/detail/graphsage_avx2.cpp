// Compiled with -mavx2 (see CMakeLists.txt); reached only after best_kernel() has asked the processor.
#include "prediction/detail/avx2_lanes.hpp"
#include "prediction/detail/graphsage_kernel.hpp"

namespace clearway::prediction::detail {
void convolve_avx2(const ConvolutionTask& task) {
    convolve<Avx2Lanes>(task);
}
void decode_avx2(const DecoderTask& task) {
    decode<Avx2Lanes>(task);
}

}  // namespace clearway::prediction::detail
