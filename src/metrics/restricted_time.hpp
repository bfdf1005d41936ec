#pragma once

#include <optional>
#include <span>

#include "metrics/vehicle_row.hpp"

namespace clearway::metrics {

/// Travel time of one vehicle, restricted to the horizon, s: that of its trip if it arrived; otherwise the
/// horizon, or its time on the road if that is longer. The rest of its route is not estimated, because the
/// position of a teleported vehicle means nothing.
double restricted_travel_time_s(const VehicleRow& vehicle, double horizon_s);

/// Restricted mean travel time of the emergency vehicles of a run, s, as survival analysis averages over
/// subjects that did not reach the event (Royston and Parmar 2013, "Restricted mean survival time", BMC
/// Medical Research Methodology 13:152): no vehicle is left out, so a condition that loses its slow vehicles
/// cannot look fast. `horizon_s` is the same for all conditions of a study. Empty without emergency vehicles.
std::optional<double> emergency_restricted_mean_s(std::span<const VehicleRow> vehicles, double horizon_s);

}  // namespace clearway::metrics
