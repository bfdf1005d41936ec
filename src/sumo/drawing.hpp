#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/ids.hpp"

namespace clearway::sumo {

struct Colour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;

    bool operator==(const Colour&) const = default;
};

/// A point of the network's plane, m.
struct Spot {
    double x_m = 0.0;
    double y_m = 0.0;

    bool operator==(const Spot&) const = default;
};

/// A line through two or more points, drawn above roads and vehicles.
struct Stroke {
    std::vector<Spot> points;
    Colour colour;
    double width_m = 1.0;

    bool operator==(const Stroke&) const = default;
};

/// What a SUMO window shows in addition to its own contents. The next drawing replaces it as a whole. It
/// changes no result.
struct Drawing {
    /// Vehicles that are not named keep their colour; those that are not on the road are skipped.
    std::vector<std::pair<core::VehicleKey, Colour>> vehicles;
    std::vector<Stroke> strokes;
    std::optional<core::VehicleKey> followed;  ///< The view follows it, if there is a window.
};

}  // namespace clearway::sumo
