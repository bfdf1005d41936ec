// Compiled with -mavx2 (see CMakeLists.txt); reached only after best_kernel() has asked the processor.
#include "prediction/detail/net_kernel_bodies.hpp"

namespace clearway::prediction::detail {

void dense_avx2(const DenseTask& task) {
    dense(task);
}

void gather_messages_avx2(const MessageTask& task) {
    gather_messages(task);
}

}  // namespace clearway::prediction::detail
