#pragma once

#include <string>
#include <string_view>

#include "roads/network.hpp"

namespace clearway::scenario {

/// A picture of the road network as a stand-alone SVG element, north up, with a scale bar: lanes drawn to
/// scale (at least a hairline), signals as dots. Colours follow `currentColor`, so it reads on light and on
/// dark pages. `title` and `credit` are escaped; the credit, which the map's data may require, can be empty.
std::string network_picture(const roads::Network& network, const std::string& title,
                            const std::string& credit);

/// What the beginning of such a picture holds. An editor of drawings that writes it anew sets it otherwise.
inline constexpr std::string_view picture_mark = "\" class=\"network\">\n<title>";

/// The same on white paper, with the number of each signal (from 1, in the order of the network) and, where
/// there is room, a street or its id.
std::string signals_picture(const roads::Network& network, const std::string& title,
                            const std::string& credit);

}  // namespace clearway::scenario
