#include "links/next_ahead.hpp"

#include <algorithm>
#include <tuple>

namespace clearway::links {

void LaneOrder::add(core::VehicleIndex row, core::LaneIndex lane, float lane_position_m) {
    if (lane.exists()) places_.push_back({lane, lane_position_m, row});
}

void LaneOrder::sort() {
    std::ranges::sort(places_, {}, [](const Place& place) {
        return std::make_tuple(place.lane, place.position_m, place.row);
    });
}

core::VehicleIndex LaneOrder::next_ahead(core::LaneIndex lane, float lane_position_m) const {
    if (!lane.exists()) return core::no_row;
    const auto next = std::ranges::upper_bound(
        places_, std::make_pair(lane, lane_position_m), {},
        [](const Place& place) { return std::make_pair(place.lane, place.position_m); });
    if (next == places_.end() || next->lane != lane) return core::no_row;
    return next->position_m - lane_position_m <= next_ahead_horizon_m ? next->row : core::no_row;
}

}  // namespace clearway::links
