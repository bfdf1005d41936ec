#pragma once

#include <string>

#include "scenario/config.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::scenario {

/// Size and dynamics of a kind of vehicle. Metres, m/s^2, m/s.
struct KindProperties {
    traffic::VehicleKind kind;
    const char* vehicle_permission;  ///< SUMO's vClass.
    const char* gui_shape;
    double length_m;
    double width_m;
    double height_m;
    double acceleration_mps2;
    double deceleration_mps2;            ///< Comfortable.
    double emergency_deceleration_mps2;  ///< What the brakes can do.
    double maximum_speed_mps;            ///< What the vehicle can do; limits are lower.
};

/// Properties of every kind but `other`. Throws std::logic_error for that one.
const KindProperties& properties(traffic::VehicleKind kind);

/// Parameters of the Intelligent Driver Model.
struct IdmParameters {
    double time_headway_s;
    double minimum_gap_m;
    double exponent;
    double acceleration_cap_mps2;  ///< A kind accelerates no faster than this, and than it can.
    double deceleration_cap_mps2;  ///< The same for comfortable braking.
};
const IdmParameters& parameters(IdmPreset preset);

/// Id of the SUMO type of such a vehicle: `human_car`, `emergency_ambulance`, `automated_car_unrestricted`.
std::string type_id(traffic::VehicleClass vehicle_class, traffic::VehicleKind kind,
                    Access access = Access::own);

/// A SUMO additional file with every type that the demand of `config` may use. Class and kind are parameters
/// of the type (traffic::class_parameter, traffic::kind_parameter); maxSpeed is the class limit; speedFactor
/// 1 without deviation (an individual factor stands at the vehicle); SUMO's own default of 1.5 for emergency
/// vehicles never applies. Friction and headway factor of `[road]` are in all of them.
std::string vehicle_types_xml(const ScenarioConfig& config);

}  // namespace clearway::scenario
