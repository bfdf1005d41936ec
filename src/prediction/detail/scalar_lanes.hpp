#pragma once

#include <cstddef>

#include "prediction/detail/lane_count.hpp"

namespace clearway::prediction::detail {

/// Eight floats handled one after the other.
struct ScalarLanes {
    float value[lane_count];

    static ScalarLanes all(float number) {
        ScalarLanes lanes{};
        for (float& lane : lanes.value) {
            lane = number;
        }
        return lanes;
    }
    static ScalarLanes load(const float* from) {
        ScalarLanes lanes{};
        for (std::size_t at = 0; at < lane_count; ++at) {
            lanes.value[at] = from[at];
        }
        return lanes;
    }
    void store(float* to) const {
        for (std::size_t at = 0; at < lane_count; ++at) {
            to[at] = value[at];
        }
    }
    template <class Operation>
    ScalarLanes with(const ScalarLanes& other, Operation operation) const {
        ScalarLanes lanes{};
        for (std::size_t at = 0; at < lane_count; ++at) {
            lanes.value[at] = operation(value[at], other.value[at]);
        }
        return lanes;
    }
    ScalarLanes operator+(const ScalarLanes& other) const {
        return with(other, [](float left, float right) { return left + right; });
    }
    ScalarLanes operator*(const ScalarLanes& other) const {
        return with(other, [](float left, float right) { return left * right; });
    }
    ScalarLanes operator/(const ScalarLanes& other) const {
        return with(other, [](float left, float right) { return left / right; });
    }
    ScalarLanes magnitude() const {
        return with(*this, [](float number, float) { return number < 0.0F ? -number : number; });
    }
    ScalarLanes at_least_zero() const {
        return with(*this, [](float number, float) { return number > 0.0F ? number : 0.0F; });
    }
};

}  // namespace clearway::prediction::detail
