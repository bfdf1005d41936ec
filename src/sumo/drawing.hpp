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

/// A line over two or more points, above roads and vehicles.
struct Stroke {
    std::vector<Spot> points;
    Colour colour;
    double width_m = 1.0;

    bool operator==(const Stroke&) const = default;
};

/// What the window of a SUMO shows beside its own: replaced as a whole by the next one. It changes no result.
struct Drawing {
    /// Vehicles that are not named keep the colour that they have; those that are not on the road are
    /// skipped.
    std::vector<std::pair<core::VehicleKey, Colour>> vehicles;
    std::vector<Stroke> strokes;
    std::optional<core::VehicleKey> followed;  ///< The view goes with it. Without effect without a window.
};

}  // namespace clearway::sumo
