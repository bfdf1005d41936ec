#include "prediction/detail/repair_kernel.hpp"
#include "prediction/detail/scalar_lanes.hpp"

namespace clearway::prediction::detail {

void dense_scalar(const DenseTask& task) {
    dense<ScalarLanes>(task);
}
void gather_messages_scalar(const MessageTask& task) {
    gather_messages<ScalarLanes>(task);
}

}  // namespace clearway::prediction::detail
