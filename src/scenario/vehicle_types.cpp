#include "scenario/vehicle_types.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "core/units.hpp"
#include "scenario/detail/own_types.hpp"
#include "traffic/departure.hpp"

namespace clearway::scenario {

namespace {

using traffic::VehicleClass;
using traffic::VehicleKind;

// Sizes and dynamics: SUMO 1.15, vClass defaults (passenger, delivery, truck, bus, emergency). The fire
// engine has the size of a medium pumper (EN 1846: medium class, 8 m assumed) and the dynamics of SUMO's
// truck, but a top speed of 100 km/h.
constexpr std::array kinds = {
    KindProperties{VehicleKind::car, "passenger", "passenger", 5.0, 1.8, 1.5, 2.6, 4.5, 9.0, 200 / 3.6},
    KindProperties{VehicleKind::van, "delivery", "delivery", 6.5, 2.16, 2.86, 2.6, 4.5, 9.0, 200 / 3.6},
    KindProperties{VehicleKind::truck, "truck", "truck", 7.1, 2.4, 2.4, 1.3, 4.0, 7.0, 130 / 3.6},
    KindProperties{VehicleKind::bus, "bus", "bus", 12.0, 2.5, 3.4, 1.2, 4.0, 7.0, 85 / 3.6},
    KindProperties{VehicleKind::ambulance, "emergency", "emergency", 6.5, 2.16, 2.86, 2.6, 4.5, 9.0,
                   200 / 3.6},
    KindProperties{VehicleKind::fire_engine, "emergency", "firebrigade", 8.0, 2.5, 3.3, 1.3, 4.0, 7.0,
                   100 / 3.6},
    KindProperties{VehicleKind::police_car, "emergency", "police", 5.0, 1.8, 1.5, 2.6, 4.5, 9.0, 200 / 3.6},
};

// sumo: tau, minGap and delta of SUMO 1.15; accelerations of the kind.
// treiber: Kesting, Treiber, Helbing 2010, "Enhanced intelligent driver model to access the impact of driving
// strategies on traffic capacity", table 1: T 1.5 s, s0 2 m, a 1.4 m/s^2, b 2.0 m/s^2.
constexpr IdmParameters sumo_parameters{1.0, 2.5, 4.0, 100.0, 100.0};
constexpr IdmParameters treiber_parameters{1.5, 2.0, 4.0, 1.4, 2.0};

// SUMO 1.15: tau, minGap and sigma of its Krauss model.
constexpr double krauss_headway_s = 1.0;
constexpr double krauss_gap_m = 2.5;
constexpr double krauss_sigma = 0.5;

double class_limit_kmh(const SpeedLimits& limits, VehicleClass vehicle_class) {
    switch (vehicle_class) {
        case VehicleClass::human:
            return limits.human_kmh;
        case VehicleClass::automated:
            return limits.automated_kmh;
        case VehicleClass::emergency:
            return limits.emergency_kmh;
    }
    throw std::logic_error("vehicle class without a limit");
}

std::string type_xml(const ScenarioConfig& config, VehicleClass vehicle_class, const KindProperties& kind,
                     Access access) {
    // The caps of a preset are those of the model idm; krauss goes with `sumo`, which has none.
    const IdmParameters& idm = parameters(config.drivers.idm);
    const ModelAttributes model = model_attributes(config, vehicle_class);
    const double friction = config.road.friction;
    const bool keeps_right = config.privilege.oncoming_lane != 0 && vehicle_class != VehicleClass::emergency;
    const double limit_mps = core::from_kmh(class_limit_kmh(config.limits, vehicle_class)).value;
    return fmt::format(
        "    <vType id=\"{}\" vClass=\"{}\" guiShape=\"{}\" length=\"{}\" width=\"{}\" height=\"{}\" "
        "minGap=\"{}\" "
        "accel=\"{:.6g}\" decel=\"{:.6g}\" emergencyDecel=\"{:.6g}\" maxSpeed=\"{:.2f}\" speedFactor=\"1\" "
        "speedDev=\"0\" "
        "carFollowModel=\"{}\" tau=\"{:.6g}\" {}=\"{}\"{}>\n"
        "        <param key=\"{}\" value=\"{}\"/>\n        <param key=\"{}\" value=\"{}\"/>\n    </vType>\n",
        type_id(vehicle_class, kind.kind, access),
        access == Access::unrestricted ? "ignoring" : kind.vehicle_permission, kind.gui_shape, kind.length_m,
        kind.width_m, kind.height_m, model.minimum_gap_m,
        std::min(kind.acceleration_mps2, idm.acceleration_cap_mps2) * friction,
        std::min(kind.deceleration_mps2, idm.deceleration_cap_mps2) * friction,
        kind.emergency_deceleration_mps2 * friction, std::min(limit_mps, kind.maximum_speed_mps), model.model,
        model.time_headway_s * config.road.headway_factor, model.extra, model.extra_value,
        keeps_right ? " lcOpposite=\"0\"" : "", traffic::class_parameter, traffic::name(vehicle_class),
        traffic::kind_parameter, traffic::name(kind.kind));
}

bool is_emergency(const KindProperties& kind) {
    return std::string_view(kind.vehicle_permission) == "emergency";
}

}  // namespace

const KindProperties& properties(VehicleKind kind) {
    for (const KindProperties& row : kinds)
        if (row.kind == kind) return row;
    throw std::logic_error("no properties for this kind of vehicle");
}

const IdmParameters& parameters(IdmPreset preset) {
    return preset == IdmPreset::sumo ? sumo_parameters : treiber_parameters;
}

ModelAttributes model_attributes(const ScenarioConfig& config, VehicleClass vehicle_class) {
    if (config.following.model == FollowingModel::krauss) {
        const double sigma = vehicle_class == VehicleClass::automated ? 0.0 : krauss_sigma;
        return {"Krauss", krauss_headway_s, krauss_gap_m, "sigma", sigma};
    }
    const IdmParameters& idm = parameters(config.drivers.idm);
    return {"IDM", idm.time_headway_s, idm.minimum_gap_m, "delta", idm.exponent};
}

std::string type_id(VehicleClass vehicle_class, VehicleKind kind, Access access) {
    return fmt::format("{}_{}{}", traffic::name(vehicle_class), traffic::name(kind),
                       access == Access::unrestricted ? "_unrestricted" : "");
}

std::string vehicle_types_xml(const ScenarioConfig& config) {
    std::vector<Access> accesses = {Access::own};
    const bool keeps_types = config.measured && config.measured->own_types;
    if (config.measured) accesses.push_back(Access::unrestricted);
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<additional>\n";
    if (keeps_types) xml += detail::own_types_xml(config);
    for (const Access access : keeps_types ? std::vector<Access>{} : accesses) {
        for (const KindProperties& kind : kinds) {
            if (is_emergency(kind)) continue;
            xml += type_xml(config, VehicleClass::human, kind, access);
            xml += type_xml(config, VehicleClass::automated, kind, access);
        }
    }
    for (const KindProperties& kind : kinds)
        if (is_emergency(kind)) xml += type_xml(config, VehicleClass::emergency, kind, Access::own);
    return xml + "</additional>\n";
}

}  // namespace clearway::scenario
