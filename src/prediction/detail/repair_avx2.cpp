// Compiled with -mavx2 (see CMakeLists.txt); reached only after best_kernel() has asked the processor.
#include "prediction/detail/avx2_lanes.hpp"
#include "prediction/detail/repair_kernel.hpp"

namespace clearway::prediction::detail {

void dense_avx2(const DenseTask& task) {
    dense<Avx2Lanes>(task);
}
void gather_messages_avx2(const MessageTask& task) {
    gather_messages<Avx2Lanes>(task);
}

}  // namespace clearway::prediction::detail
