#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/left_out.hpp"

namespace clearway::scenario_import::detail {

/// Adds `by_s` to the times at which a `<stop>` ends, where it states any.
void delay_stop(Element& stop, double by_s);

/// Stops of a vehicle that wait for a passenger, goods or another vehicle last their duration or until, for
/// whom they wait for may not be here; those with neither are taken out.
void end_waiting(Element& vehicle, LeftOut& left_out);

/// Edges of the stops that additional files define.
class StopEdges {
  public:
    explicit StopEdges(const std::vector<Element>& additional);
    /// The edge of a `<stop>`; empty when nothing says it, or when it names a place that is not there.
    std::string edge_of(const Element& stop) const;
    /// The place that a `<stop>` names and nobody defines, in words: `busStop "market"`. Else nothing.
    std::optional<std::string> unknown_place(const Element& stop) const;

  private:
    std::map<std::pair<std::string, std::string>, std::string> edges_;  ///< By kind and id.
};

}  // namespace clearway::scenario_import::detail
