#include "metrics/restricted_time.hpp"

#include <algorithm>
#include <cassert>

#include "metrics/detail/mean.hpp"

namespace clearway::metrics {

double restricted_travel_time_s(const VehicleRow& vehicle, double horizon_s) {
    assert(horizon_s >= 0.0);
    const double on_the_road_s = vehicle.travel_time_s.value_or(0.0);
    return vehicle.outcome == VehicleOutcome::arrived ? on_the_road_s : std::max(horizon_s, on_the_road_s);
}

std::optional<double> emergency_restricted_mean_s(std::span<const VehicleRow> vehicles, double horizon_s) {
    detail::Mean mean;
    for (const VehicleRow& vehicle : vehicles)
        if (vehicle.vehicle_class == traffic::VehicleClass::emergency)
            mean.add(restricted_travel_time_s(vehicle, horizon_s));
    return mean.value();
}

}  // namespace clearway::metrics
