#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "core/error.hpp"
#include "metrics/detail/elements.hpp"
#include "metrics/recorder.hpp"

namespace clearway::metrics {
namespace {

struct TypeInfo {
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    traffic::VehicleKind kind = traffic::VehicleKind::other;
};

/// Collects vehicle types and vehicles from the elements of route files.
class DemandReader {
  public:
    explicit DemandReader(std::vector<PlannedVehicle>& vehicles) : vehicles_(vehicles) {}

    void take(const detail::Element& element) {
        const std::string_view name = element.name();
        if (name == "vType") {
            type_ = &types_[std::string(element.text("id"))];
        } else if (name == "param" && type_ != nullptr) {
            take_parameter(element.text("key"), element.text("value"));
        } else if (name == "vehicle" || name == "trip") {
            type_ = nullptr;
            take_vehicle(element);
        } else if (name == "flow") {
            throw std::invalid_argument("flow: a run needs its vehicles listed one by one");
        }
    }

  private:
    void take_parameter(std::string_view key, std::string_view value) {
        if (key == traffic::class_parameter) {
            const auto vehicle_class = core::value_from<traffic::VehicleClass>(value);
            if (!vehicle_class) throw std::invalid_argument(fmt::format("{}: unknown class", value));
            type_->vehicle_class = *vehicle_class;
        } else if (key == traffic::kind_parameter) {
            const auto kind = core::value_from<traffic::VehicleKind>(value);
            if (!kind) throw std::invalid_argument(fmt::format("{}: unknown kind", value));
            type_->kind = *kind;
        }
    }

    void take_vehicle(const detail::Element& element) {
        PlannedVehicle vehicle;
        vehicle.id = element.text("id");
        vehicle.depart_s = element.number("depart");
        const auto type = types_.find(std::string(element.text("type")));
        if (type != types_.end()) {
            vehicle.vehicle_class = type->second.vehicle_class;
            vehicle.kind = type->second.kind;
        }
        vehicles_.push_back(std::move(vehicle));
    }

    std::vector<PlannedVehicle>& vehicles_;
    std::map<std::string, TypeInfo> types_;
    TypeInfo* type_ = nullptr;
};

}  // namespace

std::vector<PlannedVehicle> read_planned(std::span<const std::filesystem::path> type_and_route_files,
                                         std::span<const traffic::EmergencyDeparture> emergency) {
    std::vector<PlannedVehicle> vehicles;
    DemandReader reader(vehicles);
    for (const std::filesystem::path& file : type_and_route_files) {
        try {
            detail::for_each_element(file, [&](const detail::Element& element) { reader.take(element); });
        } catch (const core::Error&) {
            throw;  // names the file, and may be the machine's fault
        } catch (const std::runtime_error& error) {
            throw core::InputError({file.string(), error.what(), "a SUMO route file", ""});
        }
    }
    for (const traffic::EmergencyDeparture& departure : emergency) {
        vehicles.push_back(
            {departure.id, traffic::VehicleClass::emergency, departure.kind, departure.depart.value});
    }
    return vehicles;
}

std::vector<PlannedVehicle> planned_in(const std::filesystem::path& tripinfo, const traffic::Roster& roster) {
    std::vector<PlannedVehicle> vehicles;
    try {
        detail::for_each_element(tripinfo, [&](const detail::Element& element) {
            if (element.name() != "tripinfo") return;
            PlannedVehicle vehicle{.id = std::string(element.text("id"))};
            if (const traffic::VehicleInfo* info = roster.find(core::vehicle_key(vehicle.id))) {
                vehicle.vehicle_class = info->vehicle_class;
                vehicle.kind = info->kind;
            }
            vehicle.depart_s = std::max(0.0, element.number("depart") - element.number("departDelay"));
            vehicles.push_back(std::move(vehicle));
        });
    } catch (const std::runtime_error& error) {
        throw core::SimulatorError(error.what());
    }
    return vehicles;
}

}  // namespace clearway::metrics
