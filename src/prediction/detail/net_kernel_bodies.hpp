#pragma once

#include "prediction/detail/lanes.hpp"
#include "prediction/detail/net_kernel.hpp"

namespace clearway::prediction::detail {
namespace {

// Compiled once for each instruction set. All is internal to the file and uses nothing from the standard
// library, so that a file compiled for AVX2 leaves no shared function behind that an older processor could
// meet.

/// `count` rows of one group of outputs: weights are loaded once for all of them.
template <std::size_t count>
void dense_rows(const DenseTask& task, const std::size_t* rows, std::size_t at) {
    Lanes sum[count];
    for (std::size_t r = 0; r < count; ++r) {
        sum[r] = Lanes::load(task.bias != nullptr ? task.bias + at
                                                  : task.result + rows[r] * task.result_stride + at);
    }
    for (std::size_t input = 0; input < task.inputs; ++input) {
        const Lanes weight = Lanes::load(task.weight + input * task.result_stride + at);
        for (std::size_t r = 0; r < count; ++r) {
            sum[r] = sum[r] + Lanes::all(task.input[rows[r] * task.input_stride + input]) * weight;
        }
    }
    for (std::size_t r = 0; r < count; ++r) {
        if (task.rectified) sum[r] = sum[r].at_least_zero();
        sum[r].store(task.result + rows[r] * task.result_stride + at);
    }
}

void dense(const DenseTask& task) {
    constexpr std::size_t together = 6;
    std::size_t rows[together];
    for (std::size_t first = 0; first < task.row_count; first += together) {
        const std::size_t left = task.row_count - first;
        const std::size_t count = left < together ? left : together;
        for (std::size_t r = 0; r < count; ++r) {
            rows[r] = task.rows != nullptr ? task.rows[first + r] : first + r;
        }
        for (std::size_t at = 0; at < task.result_stride; at += lane_count) {
            if (count == together) {
                dense_rows<together>(task, rows, at);
                continue;
            }
            for (std::size_t r = 0; r < count; ++r) {
                dense_rows<1>(task, rows + r, at);
            }
        }
    }
}

/// Messages of one receiver along one group of lanes.
void gather_group(const MessageTask& task, std::size_t receiver, std::size_t at) {
    const std::uint32_t begin = task.first_edge[receiver];
    const std::uint32_t end = task.first_edge[receiver + 1];
    const Lanes own = Lanes::load(task.own_gate + receiver * task.width + at);
    const Lanes half = Lanes::all(0.5F);
    const Lanes one = Lanes::all(1.0F);
    Lanes sum = Lanes::all(0.0F);
    for (std::uint32_t edge = begin; edge < end; ++edge) {
        const std::size_t source = task.source[edge] * task.width + at;
        Lanes gate = own + Lanes::load(task.source_gate + source);
        Lanes value = Lanes::load(task.source_value + source);
        const float* const numbers = task.edges + edge * task.edge_width;
        for (std::size_t i = 0; i < task.edge_width; ++i) {
            // Most numbers of an edge are flags that are not set; leaving them out changes no bit.
            if (numbers[i] == 0.0F) continue;
            const Lanes number = Lanes::all(numbers[i]);
            gate = gate + number * Lanes::load(task.edge_gate + i * task.width + at);
            value = value + number * Lanes::load(task.edge_value + i * task.width + at);
        }
        sum = sum + (half + half * gate / (one + gate.magnitude())) * value;
    }
    const auto count = static_cast<float>(end > begin ? end - begin : 1);
    (sum / Lanes::all(count)).store(task.mean + receiver * task.width + at);
}

void gather_messages(const MessageTask& task) {
    for (std::size_t receiver = 0; receiver < task.receiver_count; ++receiver) {
        for (std::size_t at = 0; at < task.width; at += lane_count) {
            gather_group(task, receiver, at);
        }
    }
}

}  // namespace
}  // namespace clearway::prediction::detail
