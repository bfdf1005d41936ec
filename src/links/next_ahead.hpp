#pragma once

#include <vector>

#include "core/ids.hpp"
#include "core/match_rows.hpp"

namespace clearway::links {

/// How far ahead along the lane the next vehicle is looked for, m.
inline constexpr float next_ahead_horizon_m = 100.0F;

/// Vehicles in the order of their lanes, to find the next one ahead in a lane. Keeps its buffer.
class LaneOrder {
  public:
    void clear() { places_.clear(); }
    /// A vehicle without a lane is nobody's next and has none.
    void add(core::VehicleIndex row, core::LaneIndex lane, float lane_position_m);
    /// Call after the last `add`.
    void sort();

    /// Row of the nearest vehicle further ahead on the lane, at most `next_ahead_horizon_m` along it;
    /// `core::no_row` if there is none. A vehicle at the same position is not ahead. O(log vehicles).
    core::VehicleIndex next_ahead(core::LaneIndex lane, float lane_position_m) const;

  private:
    struct Place {
        core::LaneIndex lane;
        float position_m = 0.0F;
        core::VehicleIndex row = 0;
    };
    std::vector<Place> places_;
};

}  // namespace clearway::links
