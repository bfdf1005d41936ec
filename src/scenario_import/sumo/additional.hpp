#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/left_out.hpp"

namespace clearway::scenario_import::detail {

/// Contents of additional.add.xml.
struct Additional {
    std::string xml;  ///< Without root element; its first line is line 3 of the file.
    std::map<unsigned long, std::string> places;  ///< Original places, by line of additional.add.xml.
};

/// Keeps the elements of additional files that affect the traffic, and detectors that a signal program names;
/// the others observe it, write files or are drawn. Times count from `begin_s`, also the offsets of signal
/// programs. Elements name the `types` as a run calls them.
Additional keep_additional(const std::vector<Element>& elements, const std::map<std::string, Element>& types,
                           double begin_s, LeftOut& left_out);

/// Whether such an element affects the traffic.
bool shapes_traffic(const Element& element);

}  // namespace clearway::scenario_import::detail
