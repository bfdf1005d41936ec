#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "traffic/signal.hpp"

namespace clearway::traffic {

/// Whether a signal holds back a vehicle that uses these links: one of them shows no green, or is not known.
inline bool holds_back(const std::string& shown, std::span<const std::uint16_t> links) {
    return std::any_of(links.begin(), links.end(),
                       [&](std::uint16_t link) { return link >= shown.size() || !is_green(shown[link]); });
}

/// How fast a vehicle may be at this distance, m, from a stop line that it passes at `at_line_mps`, when it
/// brakes with `braking_mps2`. A line behind it counts as here.
inline double speed_before_line(double at_line_mps, double braking_mps2, double distance_m) {
    return std::sqrt(at_line_mps * at_line_mps + 2.0 * braking_mps2 * std::max(0.0, distance_m));
}

}  // namespace clearway::traffic
