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
    double emergency_deceleration_mps2;  ///< The strongest possible.
    double maximum_speed_mps;            ///< Top speed of the vehicle; limits are lower.
};

/// Properties of a kind. Throws std::logic_error for `other`.
const KindProperties& properties(traffic::VehicleKind kind);

/// Parameters of the Intelligent Driver Model.
struct IdmParameters {
    double time_headway_s;
    double minimum_gap_m;
    double exponent;
    double acceleration_cap_mps2;  ///< Upper bound on the acceleration of every kind.
    double deceleration_cap_mps2;  ///< The same for comfortable braking.
};
const IdmParameters& parameters(IdmPreset preset);

/// The attributes of a SUMO type that choose the car-following model of a class: model, headway and what is
/// particular to the model. Without the headway factor of `[road]`.
struct ModelAttributes {
    const char* model;  ///< SUMO's name.
    double time_headway_s;
    double minimum_gap_m;
    const char* extra;  ///< Name of the model's own attribute.
    double extra_value;
};
/// Of SUMO's Krauss model, automated vehicles do not dawdle (sigma 0): that is an imperfection of humans.
ModelAttributes model_attributes(const ScenarioConfig& config, traffic::VehicleClass vehicle_class);

/// Id of the SUMO type of these vehicles: `human_car`, `emergency_ambulance`, `automated_car_unrestricted`.
std::string type_id(traffic::VehicleClass vehicle_class, traffic::VehicleKind kind,
                    Access access = Access::own);

/// A SUMO additional file with every type that the demand of `config` may use. Class and kind are parameters
/// of the type (traffic::class_parameter, traffic::kind_parameter); maxSpeed is the class limit; speedFactor
/// is 1 without deviation (each vehicle has its individual factor), so SUMO's default of 1.5 for emergency
/// vehicles never applies. All include friction and headway factor of `[road]`.
std::string vehicle_types_xml(const ScenarioConfig& config);

}  // namespace clearway::scenario
