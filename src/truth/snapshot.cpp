#include "truth/snapshot.hpp"

#include <algorithm>

namespace clearway::truth {

void Snapshot::resize(std::size_t rows) {
    key.resize(rows);
    vehicle_class.resize(rows);
    for (std::vector<float>* column :
         {&x_m, &y_m, &heading_rad, &speed_mps, &acceleration_mps2, &lane_position_m}) {
        column->resize(rows);
    }
    lane.resize(rows);
    route_edge.resize(rows);
}

std::optional<core::VehicleIndex> Snapshot::row_of(core::VehicleKey vehicle) const {
    const auto found = std::ranges::lower_bound(key, vehicle);
    if (found == key.end() || *found != vehicle) return std::nullopt;
    return static_cast<core::VehicleIndex>(found - key.begin());
}

traffic::MotionState Snapshot::motion(core::VehicleIndex row) const {
    return {.x_m = x_m[row],
            .y_m = y_m[row],
            .heading_rad = heading_rad[row],
            .speed_mps = speed_mps[row],
            .lane = lane[row],
            .lane_position_m = lane_position_m[row],
            .route_edge = route_edge[row]};
}

}  // namespace clearway::truth
