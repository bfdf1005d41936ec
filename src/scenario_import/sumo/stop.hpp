#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/left_out.hpp"

namespace clearway::scenario_import::detail {

/// Lets stops of a vehicle that wait for a passenger, goods or another vehicle end after `duration` or at
/// `until`, because what they wait for may not exist here. Stops with neither are removed.
void end_waiting(Element& vehicle, LeftOut& left_out);

/// Whether elements of this name are places for the stops of vehicles.
bool is_place_of_stops(const std::string& name);

/// Edges of the stops that additional files define.
class StopEdges {
  public:
    explicit StopEdges(const std::vector<Element>& additional);
    /// The edge of a `<stop>`; empty when it names none, or a place that does not exist.
    std::string edge_of(const Element& stop) const;
    /// The place that a `<stop>` names but that is not defined, in words: `busStop "market"`. Otherwise
    /// nothing.
    std::optional<std::string> unknown_place(const Element& stop) const;

  private:
    std::map<std::pair<std::string, std::string>, std::string> edges_;  ///< By kind and id.
};

}  // namespace clearway::scenario_import::detail
