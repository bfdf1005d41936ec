#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "actuation/fakes.hpp"

namespace clearway::testing {

inline const core::SignalIndex signal_a{0};
inline const std::vector<std::uint16_t> west = {12, 13, 14, 15};
inline const std::vector<std::uint16_t> north = {0, 1, 2, 3};
inline const std::vector<std::uint16_t> south_straight = {9, 10};

/// What a signal showed and for how long.
struct Shown {
    std::string state;
    double from_s;
};

/// Drives the bench, renewing holds while `renew` says so, and notes every change of the signal.
template <class Renew>
std::vector<Shown> watch(ActuationBench& bench, double until_s, const Renew& renew) {
    std::vector<Shown> history = {{bench.shown[0], 0.0}};
    while (bench.now.value < until_s - 1e-9) {
        renew(bench);
        bench.step();
        if (bench.shown[0] != history.back().state) history.push_back({bench.shown[0], bench.now.value});
    }
    return history;
}

inline auto hold_until(const std::vector<std::uint16_t>& links, double end_s) {
    return [=](ActuationBench& bench) {
        if (bench.now.value < end_s) bench.offer(signal_a, traffic::HoldGreen{links}, 2.0);
    };
}

}  // namespace clearway::testing
