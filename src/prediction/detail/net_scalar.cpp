#include "prediction/detail/net_kernel_bodies.hpp"

namespace clearway::prediction::detail {

void dense_scalar(const DenseTask& task) {
    dense(task);
}

void gather_messages_scalar(const MessageTask& task) {
    gather_messages(task);
}

}  // namespace clearway::prediction::detail
