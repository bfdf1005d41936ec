#pragma once

#include <string>
#include <unordered_map>

#include "sumo/detail/gateway.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::sumo::detail {

/// A SUMO vehicle type as Clearway reads it.
struct VehicleType {
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    traffic::VehicleKind kind = traffic::VehicleKind::other;
    gateway::TypeReading dynamics;
};

/// Vehicle types, each read from SUMO once.
class TypeTable {
  public:
    /// `sumo` outlives the table.
    explicit TypeTable(gateway::Sumo& sumo) : sumo_(sumo) {}

    /// Throws core::InputError when a class or kind parameter has a value that does not exist.
    const VehicleType& get(const std::string& type);

  private:
    VehicleType read(const std::string& type) const;

    gateway::Sumo& sumo_;
    std::unordered_map<std::string, VehicleType> types_;
};

}  // namespace clearway::sumo::detail
