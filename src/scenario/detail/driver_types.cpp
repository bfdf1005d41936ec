#include "scenario/detail/driver_types.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "scenario/detail/xml_text.hpp"
#include "scenario/vehicle_types.hpp"
#include "traffic/departure.hpp"

namespace clearway::scenario::detail {
namespace {

/// Numbers of the random draws for one driver; 0 and 4 are those of demand.cpp. Never renumber them.
enum TypeDraw : std::uint64_t { headway = 1, acceleration = 2, deceleration = 3 };

constexpr double least_factor = 0.5;
constexpr double largest_factor = 2.0;
constexpr double standard_headway_s = 1.0;  // SUMO's tau

double factor_of(const DemandContext& context, const std::string& vehicle, TypeDraw draw) {
    const double spread = context.config.following.driver_spread;
    const double variance = std::log1p(spread * spread);
    const double normal =
        context.random.normal(core::Purpose::driver, core::vehicle_key(vehicle).value, draw);
    return std::clamp(std::exp(std::sqrt(variance) * normal - variance / 2.0), least_factor, largest_factor);
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
    pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute) attribute = node.append_attribute(name);
    attribute.set_value(value.c_str());
}

/// SUMO's numbers for the kind of a type; nothing for kinds without such numbers.
const KindProperties* kind_of(pugi::xml_node type) {
    const pugi::xml_node kind = type.find_child_by_attribute("param", "key", traffic::kind_parameter);
    const auto value = core::value_from<traffic::VehicleKind>(kind.attribute("value").value());
    return !value || *value == traffic::VehicleKind::other ? nullptr : &properties(*value);
}

/// Multiplies an attribute of the type and of the car-following model nested in it.
void scale(pugi::xml_node type, const char* name, double factor, std::optional<double> standard) {
    if (!type.attribute(name) && standard) set(type, name, fmt::format("{}", *standard));
    const auto multiply = [&](pugi::xml_node node) {
        if (node.attribute(name))
            set(node, name, fmt::format("{:.6g}", node.attribute(name).as_double() * factor));
    };
    multiply(type);
    for (const pugi::xml_node nested : type.children())
        multiply(nested);
}

void keep_emergency_braking(pugi::xml_node type, const KindProperties* kind) {
    const pugi::xml_attribute hardest = type.attribute("emergencyDecel");
    if (!hardest && kind == nullptr) return;
    const double hardest_mps2 = hardest ? hardest.as_double() : kind->emergency_deceleration_mps2;
    const pugi::xml_attribute usual = type.attribute("decel");
    if (usual.as_double() > hardest_mps2) set(type, "emergencyDecel", usual.value());
}

}  // namespace

bool has_own_type(const ScenarioConfig& config, traffic::VehicleClass vehicle_class) {
    return config.following.driver_spread > 0.0 && vehicle_class == traffic::VehicleClass::human;
}

std::string driver_type_id(const std::string& type, const std::string& vehicle) {
    return fmt::format("{}_driver_{:016x}", type, core::vehicle_key(vehicle).value);
}

std::string with_driver_types(const DemandContext& context, const PlannedDemand& demand,
                              const std::string& types) {
    pugi::xml_document document;
    document.load_string(types.c_str());
    std::map<std::string_view, pugi::xml_node> by_id;
    for (const pugi::xml_node type : document.document_element().children("vType"))
        by_id[type.attribute("id").value()] = type;
    std::string own;
    pugi::xml_document written;
    for (const PlannedVehicle& vehicle : demand.vehicles) {
        if (vehicle.own_type_of.empty()) continue;
        pugi::xml_node type = written.append_copy(by_id.at(vehicle.own_type_of));
        const KindProperties* const kind = kind_of(type);
        const auto standard = [&](double KindProperties::*member) {
            return kind == nullptr ? std::nullopt : std::optional(kind->*member);
        };
        set(type, "id", driver_type_id(vehicle.own_type_of, vehicle.id));
        scale(type, "tau", factor_of(context, vehicle.id, headway), standard_headway_s);
        scale(type, "accel", factor_of(context, vehicle.id, acceleration),
              standard(&KindProperties::acceleration_mps2));
        scale(type, "decel", factor_of(context, vehicle.id, deceleration),
              standard(&KindProperties::deceleration_mps2));
        keep_emergency_braking(type, kind);
        own += element_text(type);
        written.remove_child(type);
    }
    if (own.empty()) return types;
    const std::size_t end = types.rfind("</additional>");
    return types.substr(0, end) + own + types.substr(end);
}

}  // namespace clearway::scenario::detail
