#pragma once

#include <string>

#include "scenario/detail/demand.hpp"

namespace clearway::scenario::detail {

/// Whether drivers of this class have types of their own, because they differ: human drivers, with
/// `car_following.driver_spread` above 0.
bool has_own_type(const ScenarioConfig& config, traffic::VehicleClass vehicle_class);

/// Id of the SUMO type of one driver, who is like those of type `type` otherwise. The vehicle's id is in it
/// as a hash, for SUMO allows fewer characters in types.
std::string driver_type_id(const std::string& type, const std::string& vehicle);

/// `types` (scenario::vehicle_types_xml) with a type for each vehicle of `demand` that has one of its own
/// (PlannedVehicle::own_type_of). Headway, acceleration and deceleration are those of the type times one
/// factor each: log-normal with mean 1 and relative standard deviation `driver_spread`, kept in [0.5, 2],
/// drawn by vehicle. A larger spread scales the same draws. Emergency braking is at least as hard as the
/// usual one. Numbers that a type leaves to SUMO are scaled where SUMO's default is known for its kind.
std::string with_driver_types(const DemandContext& context, const PlannedDemand& demand,
                              const std::string& types);

}  // namespace clearway::scenario::detail
