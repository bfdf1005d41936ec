#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "roads/lane_grid.hpp"
#include "roads/network.hpp"
#include "roads/route.hpp"

namespace clearway::roads {

/// A position and heading with errors, as a receiver gets them.
struct Sighting {
    Point point;
    double heading_rad = 0.0;
    double position_sigma_m = 0.0;  ///< Standard error along each axis.
    double heading_sigma_rad = 0.0;
};

/// Where on the map a sighting is believed to be.
struct MatchedPlace {
    core::LaneIndex lane;
    float position_m = 0.0F;
    /// Position in the route of the last edge outside junctions that was entered; 0 off the route.
    std::uint32_t route_edge = 0;
};

/// Finds the lane of a sighting from map, position, heading and, where it is known, the route. It keeps no
/// memory: each sighting is matched by itself.
///
/// A lane is plausible when its middle line is nearer than 5 m + 3.5 position errors and its direction there
/// differs by at most 45 degrees + 3 heading errors. Of the plausible lanes that one is taken for which
/// (distance / position error)^2 + (difference of direction / heading error)^2 is least, with errors of at
/// least 1 m and 10 degrees; of two alike, the one listed first in the network.
///
/// With a route, lanes of its edges and of its ways through junctions come first, however near others are;
/// only when none of them is plausible, lanes off the route count, and then only outside junctions. An edge
/// that the route passes several times counts as its first passage. Lanes off the route must be open to cars
/// or emergency vehicles.
///
/// `match` reuses a buffer, so threads need matchers of their own; the network outlives the matcher.
class MapMatcher {
  public:
    explicit MapMatcher(const Network& network);

    /// Nothing when no lane is plausible. `route` is empty when it is not known.
    std::optional<MatchedPlace> match(const Sighting& sighting, Route route);

  private:
    /// Edges outside junctions before and behind a lane inside one.
    struct Way {
        core::EdgeIndex from, to;
    };
    std::optional<std::uint32_t> place_in(Route route, core::LaneIndex lane) const;
    bool is_open_road(core::LaneIndex lane, Route route) const;

    const Network& network_;
    LaneGrid grid_;
    std::vector<Way> ways_;  ///< By lane; without edges outside junctions.
    std::vector<LanePlace> near_;
};

}  // namespace clearway::roads
