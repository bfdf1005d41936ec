#include "scenario/detail/own_types.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "core/error.hpp"
#include "scenario/detail/xml_text.hpp"
#include "scenario/vehicle_types.hpp"
#include "traffic/departure.hpp"

namespace clearway::scenario::detail {

namespace {

using traffic::VehicleClass;

void set_text(pugi::xml_node node, const char* name, const std::string& value) {
    node.remove_attribute(name);
    node.append_attribute(name).set_value(value.c_str());
}

void follow_by(pugi::xml_node type, const ModelAttributes& model) {
    while (pugi::xml_node nested = type.find_child([](pugi::xml_node child) {
        return std::string_view(child.name()).starts_with("carFollowing-");
    }))
        type.remove_child(nested);
    type.remove_attribute("speedDev");
    set_text(type, "carFollowModel", model.model);
    set_text(type, "tau", fmt::format("{}", model.time_headway_s));
    set_text(type, model.extra, fmt::format("{}", model.extra_value));
    set_text(type, "minGap", fmt::format("{}", model.minimum_gap_m));
    set_text(type, "speedFactor", "1");
    set_text(type, "speedDev", "0");
}

/// Limits the top speed to `limit_kmh`. A type without one of its own has that of its kind.
void limit_speed(pugi::xml_node type, const MeasuredType& listed, double limit_kmh) {
    const pugi::xml_attribute own = type.attribute("maxSpeed");
    if (!own && listed.kind == "other") return;
    const double limit_mps = core::from_kmh(limit_kmh).value;
    const double fastest_mps =
        own ? own.as_double()
            : properties(*core::value_from<traffic::VehicleKind>(listed.kind)).maximum_speed_mps;
    set_text(type, "maxSpeed", fmt::format("{:.2f}", std::min(limit_mps, fastest_mps)));
}

/// Multiplies an attribute of the type (`standard` if it has none) and of the car-following model nested in
/// it.
void scale(pugi::xml_node type, const char* name, double factor, double standard) {
    const auto multiply = [&](pugi::xml_node node, double value) {
        set_text(node, name, fmt::format("{:.6g}", value * factor));
    };
    multiply(type, type.attribute(name).as_double(standard));
    for (const pugi::xml_node nested : type.children())
        if (nested.attribute(name)) multiply(nested, nested.attribute(name).as_double());
}

/// Types that are not car, van, truck or bus keep their grip: no file has SUMO's defaults for them.
void feel_road(pugi::xml_node type, const MeasuredType& listed, const RoadCondition& road) {
    if (listed.kind == "other") return;
    const KindProperties& kind = properties(*core::value_from<traffic::VehicleKind>(listed.kind));
    if (road.friction != 1.0) {
        scale(type, "accel", road.friction, kind.acceleration_mps2);
        scale(type, "decel", road.friction, kind.deceleration_mps2);
        scale(type, "emergencyDecel", road.friction, kind.emergency_deceleration_mps2);
    }
    constexpr double standard_headway_s = 1.0;  // SUMO's tau
    if (road.headway_factor != 1.0) scale(type, "tau", road.headway_factor, standard_headway_s);
}

void add_parameter(pugi::xml_node type, const char* key, std::string_view value) {
    pugi::xml_node parameter = type.append_child("param");
    parameter.append_attribute("key").set_value(key);
    parameter.append_attribute("value").set_value(std::string(value).c_str());
}

class TypeWriter {
  public:
    explicit TypeWriter(const ScenarioConfig& config)
        : config_(config),
          own_(*config.measured->own_types),
          place_(resolve(config, own_.file).string()),
          document_(load_xml(place_, "an additional file of SUMO")) {
        for (const pugi::xml_node type : document_.document_element().children("vType"))
            types_[type.attribute("id").value()] = type;
    }

    std::string text() {
        pugi::xml_document written;
        for (const MeasuredType& listed : config_.measured->types) {
            const auto type = types_.find(listed.id);
            if (type == types_.end()) {
                problems_.push_back({place_, fmt::format("has no vType \"{}\"", listed.id),
                                     "a vType for each [[measured.type]]", "add it"});
                continue;
            }
            add(written, type->second, listed, VehicleClass::human);
            if (listed.kind == "car") add(written, type->second, listed, VehicleClass::automated);
        }
        if (!problems_.empty()) throw core::InputError(problems_);
        std::string xml;
        for (const pugi::xml_node type : written.children())
            xml += element_text(type);
        return xml;
    }

  private:
    void add(pugi::xml_document& written, pugi::xml_node source, const MeasuredType& listed,
             VehicleClass vehicle_class) {
        pugi::xml_node type = written.append_copy(source);
        set_text(type, "id", own_type_id(vehicle_class, listed.id));
        const bool automated = vehicle_class == VehicleClass::automated;
        if (automated || own_.car_following == CarFollowing::idm)
            follow_by(type, model_attributes(config_, vehicle_class));
        limit_speed(type, listed, automated ? config_.limits.automated_kmh : config_.limits.human_kmh);
        feel_road(type, listed, config_.road);
        add_parameter(type, traffic::class_parameter, traffic::name(vehicle_class));
        add_parameter(type, traffic::kind_parameter, listed.kind);
    }

    const ScenarioConfig& config_;
    const OwnTypes& own_;
    std::string place_;
    pugi::xml_document document_;
    std::map<std::string, pugi::xml_node> types_;
    std::vector<core::Problem> problems_;
};

}  // namespace

std::string own_type_id(VehicleClass vehicle_class, const std::string& type) {
    return fmt::format("{}.{}", traffic::name(vehicle_class), type);
}

std::string own_types_xml(const ScenarioConfig& config) {
    return TypeWriter(config).text();
}

}  // namespace clearway::scenario::detail
