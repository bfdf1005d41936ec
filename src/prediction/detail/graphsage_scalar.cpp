#include "prediction/detail/graphsage_kernel.hpp"
#include "prediction/detail/scalar_lanes.hpp"

namespace clearway::prediction::detail {
void convolve_scalar(const ConvolutionTask& task) {
    convolve<ScalarLanes>(task);
}
void decode_scalar(const DecoderTask& task) {
    decode<ScalarLanes>(task);
}

}  // namespace clearway::prediction::detail
