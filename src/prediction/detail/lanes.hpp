#pragma once

#include <cstddef>

#include "prediction/detail/lane_count.hpp"

namespace clearway::prediction::detail {
namespace {

/// Eight floats handled at once, by what the file is compiled for: one register of AVX2, or several smaller
/// ones. Every operation rounds as that of one float does, so all files give the same bits. Internal to each
/// file.
struct Lanes {
    typedef float Floats __attribute__((vector_size(lane_count * sizeof(float))));
    Floats value;

    static Lanes all(float number) { return {number - Floats{}}; }
    static Lanes load(const float* from) {
        Lanes lanes;
        __builtin_memcpy(&lanes.value, from, sizeof lanes.value);
        return lanes;
    }
    void store(float* to) const { __builtin_memcpy(to, &value, sizeof value); }

    Lanes operator+(const Lanes& other) const { return {value + other.value}; }
    Lanes operator*(const Lanes& other) const { return {value * other.value}; }
    Lanes operator/(const Lanes& other) const { return {value / other.value}; }
    Lanes magnitude() const { return {value < 0.0F ? -value : value}; }
    Lanes at_least_zero() const { return {value > 0.0F ? value : Floats{}}; }
};

}  // namespace
}  // namespace clearway::prediction::detail
