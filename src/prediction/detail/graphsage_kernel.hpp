#pragma once

#include <cstddef>
#include <cstdint>

#include "prediction/detail/lane_count.hpp"

namespace clearway::prediction::detail {

/// One SAGEConv. Strides in floats, multiples of lane_count. Weights as [input][output_stride].
struct ConvolutionTask {
    const float* rows = nullptr;
    std::size_t row_stride = 0;
    std::size_t row_count = 0;
    const std::uint32_t* first = nullptr;
    const std::uint32_t* source = nullptr;
    const float* neighbour = nullptr;
    const float* own = nullptr;
    const float* bias = nullptr;
    std::size_t inputs = 0;
    std::size_t output_stride = 0;
    float* mean = nullptr;  ///< Scratch, row_stride.
    float* result = nullptr;
};

/// The decoder over pairs (left, right, left, right, ...).
struct DecoderTask {
    const float* embeddings = nullptr;
    std::size_t embedding_stride = 0;
    std::size_t embedding_width = 0;
    const std::uint32_t* pairs = nullptr;
    std::size_t pair_count = 0;
    const float* weight = nullptr;  ///< [embedding_width][hidden_stride]
    const float* bias = nullptr;
    const float* output_weight = nullptr;
    float output_bias = 0.0F;
    std::size_t hidden_stride = 0;
    float* logits = nullptr;
};

void convolve_scalar(const ConvolutionTask& task);
void convolve_avx2(const ConvolutionTask& task);
void decode_scalar(const DecoderTask& task);
void decode_avx2(const DecoderTask& task);

// The bodies, compiled once for each kind of lanes. They use nothing from the standard library, so that a
// file compiled for AVX2 leaves no shared function behind that an older processor could meet.

template <class Lanes>
void mean_of_sources(const ConvolutionTask& task, std::size_t row) {
    const std::uint32_t begin = task.first[row];
    const std::uint32_t end = task.first[row + 1];
    const auto count = static_cast<float>(end > begin ? end - begin : 1);
    for (std::size_t at = 0; at < task.row_stride; at += lane_count) {
        Lanes sum = Lanes::all(0.0F);
        for (std::uint32_t message = begin; message < end; ++message) {
            sum = sum + Lanes::load(task.rows + task.source[message] * task.row_stride + at);
        }
        (sum / Lanes::all(count)).store(task.mean + at);
    }
}

template <class Lanes>
void convolve(const ConvolutionTask& task) {
    for (std::size_t row = 0; row < task.row_count; ++row) {
        mean_of_sources<Lanes>(task, row);
        const float* const own_row = task.rows + row * task.row_stride;
        for (std::size_t at = 0; at < task.output_stride; at += lane_count) {
            Lanes sum = Lanes::load(task.bias + at);
            for (std::size_t input = 0; input < task.inputs; ++input) {
                const std::size_t weight = input * task.output_stride + at;
                sum = sum + Lanes::all(task.mean[input]) * Lanes::load(task.neighbour + weight);
                sum = sum + Lanes::all(own_row[input]) * Lanes::load(task.own + weight);
            }
            sum.store(task.result + row * task.output_stride + at);
        }
    }
}

template <class Lanes>
void decode(const DecoderTask& task) {
    for (std::size_t pair = 0; pair < task.pair_count; ++pair) {
        const float* const left = task.embeddings + task.pairs[2 * pair] * task.embedding_stride;
        const float* const right = task.embeddings + task.pairs[2 * pair + 1] * task.embedding_stride;
        Lanes total = Lanes::all(0.0F);
        for (std::size_t at = 0; at < task.hidden_stride; at += lane_count) {
            Lanes sum = Lanes::load(task.bias + at);
            for (std::size_t input = 0; input < task.embedding_width; ++input) {
                sum = sum + Lanes::all(left[input] * right[input]) *
                                Lanes::load(task.weight + input * task.hidden_stride + at);
            }
            total = total + sum.at_least_zero() * Lanes::load(task.output_weight + at);
        }
        float lanes[lane_count];
        total.store(lanes);
        float logit = task.output_bias;
        for (const float lane : lanes) {
            logit += lane;
        }
        task.logits[pair] = logit;
    }
}

}  // namespace clearway::prediction::detail
