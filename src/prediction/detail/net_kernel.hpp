#pragma once

#include <cstddef>
#include <cstdint>

namespace clearway::prediction::detail {

/// result[row] = bias + sum_i input[row][i] weight[i]; if `rectified`, negative results become 0. Strides in
/// floats; `result_stride` is a multiple of lane_count, as are the rows of `weight`.
struct DenseTask {
    const float* input = nullptr;
    std::size_t input_stride = 0;
    std::size_t inputs = 0;
    const std::uint32_t* rows = nullptr;  ///< Numbers of the rows to do; null: 0 ... row_count - 1.
    std::size_t row_count = 0;
    const float* weight = nullptr;  ///< [inputs][result_stride]
    const float* bias = nullptr;    ///< Null: adds to `result`.
    bool rectified = false;
    float* result = nullptr;
    std::size_t result_stride = 0;
};

/// Gated mean of messages for each receiver. All rows are `width` floats, a multiple of lane_count.
struct MessageTask {
    std::size_t receiver_count = 0;
    const std::uint32_t* first_edge = nullptr;
    const std::uint32_t* source = nullptr;
    const float* edges = nullptr;  ///< [edges][edge_width]
    std::size_t edge_width = 0;
    std::size_t width = 0;
    const float* source_gate = nullptr;   ///< [vehicles][width]
    const float* source_value = nullptr;  ///< [vehicles][width]
    const float* own_gate = nullptr;      ///< [receivers][width]
    const float* edge_gate = nullptr;     ///< [edge_width][width]
    const float* edge_value = nullptr;    ///< [edge_width][width]
    float* mean = nullptr;                ///< [receivers][width]
};

void dense_scalar(const DenseTask& task);
void dense_avx2(const DenseTask& task);
void gather_messages_scalar(const MessageTask& task);
void gather_messages_avx2(const MessageTask& task);

}  // namespace clearway::prediction::detail
