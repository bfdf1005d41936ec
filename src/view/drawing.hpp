#pragma once

#include <cstdint>
#include <string>

#include "roads/network.hpp"

namespace clearway::view {

/// Where places of frames count from: the lower left corner of the network.
struct Origin {
    double x_m = 0.0, y_m = 0.0;

    std::int32_t x(double metres) const;
    std::int32_t y(double metres) const;
};
Origin origin_of(const roads::Network& network);

/// The network as a page draws it: JSON with `quantum_m`, `origin_m`, `size`, `lanes` (their `kind`, `width`
/// and `shape`), `edges` (for each the number of its first lane, then how many it has) and `signals` (their
/// `id` and, by link number, the stop lines that the link controls: x, y, heading of the road in degrees,
/// width). Places are whole numbers of `quantum_m` from the origin, those of a shape each as its difference
/// from the one before.
std::string drawing_of(const roads::Network& network);

}  // namespace clearway::view
