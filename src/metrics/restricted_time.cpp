#include "metrics/restricted_time.hpp"

#include <algorithm>

namespace clearway::metrics {

double restricted_travel_time_s(const VehicleRow& vehicle, double horizon_s) {
    const double on_the_road_s = vehicle.travel_time_s.value_or(0.0);
    return vehicle.outcome == VehicleOutcome::arrived ? on_the_road_s : std::max(horizon_s, on_the_road_s);
}

std::optional<double> emergency_restricted_mean_s(std::span<const VehicleRow> vehicles, double horizon_s) {
    double sum_s = 0.0;
    std::size_t count = 0;
    for (const VehicleRow& vehicle : vehicles) {
        if (vehicle.vehicle_class != traffic::VehicleClass::emergency) continue;
        sum_s += restricted_travel_time_s(vehicle, horizon_s);
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum_s / static_cast<double>(count);
}

}  // namespace clearway::metrics
