#include "sumo/detail/type_table.hpp"

#include <vector>

#include "core/error.hpp"
#include "traffic/departure.hpp"

namespace clearway::sumo::detail {
namespace {

void report(std::vector<core::Problem>& problems, const std::string& type, const char* parameter,
            const std::string& value, const char* allowed) {
    problems.push_back({"vehicle type '" + type + "', parameter " + parameter,
                        "'" + value + "' does not exist", allowed, ""});
}

}  // namespace

VehicleType TypeTable::read(const std::string& type) const {
    VehicleType result{.dynamics = sumo_.read_type(type)};
    std::vector<core::Problem> problems;
    const std::string class_name = sumo_.type_parameter(type, traffic::class_parameter);
    if (const auto vehicle_class = core::value_from<traffic::VehicleClass>(class_name))
        result.vehicle_class = *vehicle_class;
    else if (!class_name.empty())
        report(problems, type, traffic::class_parameter, class_name, "human, automated, emergency");
    else if (sumo_.permission_class(type) == "emergency")
        result.vehicle_class = traffic::VehicleClass::emergency;
    const std::string kind_name = sumo_.type_parameter(type, traffic::kind_parameter);
    if (const auto kind = core::value_from<traffic::VehicleKind>(kind_name))
        result.kind = *kind;
    else if (!kind_name.empty())
        report(problems, type, traffic::kind_parameter, kind_name,
               "car, van, truck, bus, ambulance, fire_engine, police_car, other");
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return result;
}

const VehicleType& TypeTable::get(const std::string& type) {
    const auto found = types_.find(type);
    if (found != types_.end()) return found->second;
    return types_.emplace(type, read(type)).first->second;
}

}  // namespace clearway::sumo::detail
