#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/ids.hpp"
#include "core/spellings.hpp"

namespace clearway::traffic {

/// Who decides for a vehicle: a human (HV), an automated system (AV), or an emergency crew (EV).
enum class VehicleClass : std::uint8_t { human, automated, emergency };
inline constexpr std::array vehicle_classes = {VehicleClass::human, VehicleClass::automated,
                                               VehicleClass::emergency};

/// The kind of vehicle, which determines its size and dynamics.
enum class VehicleKind : std::uint8_t { car, van, truck, bus, ambulance, fire_engine, police_car, other };

constexpr core::Spellings<VehicleClass, 3> spellings(VehicleClass) {
    return {{{VehicleClass::human, "human"},
             {VehicleClass::automated, "automated"},
             {VehicleClass::emergency, "emergency"}}};
}
constexpr core::Spellings<VehicleKind, 8> spellings(VehicleKind) {
    return {{{VehicleKind::car, "car"},
             {VehicleKind::van, "van"},
             {VehicleKind::truck, "truck"},
             {VehicleKind::bus, "bus"},
             {VehicleKind::ambulance, "ambulance"},
             {VehicleKind::fire_engine, "fire_engine"},
             {VehicleKind::police_car, "police_car"},
             {VehicleKind::other, "other"}}};
}
using core::name;

/// The constant properties of a vehicle during a run, as in its registration.
struct VehicleInfo {
    core::VehicleKey key;
    std::string id;  ///< SUMO's id; text from a file, so printers escape it.
    VehicleClass vehicle_class = VehicleClass::human;
    VehicleKind kind = VehicleKind::car;
    float length_m = 5.0F;
    float width_m = 1.8F;
    float minimum_gap_m = 2.5F;
    float maximum_speed_mps = 55.6F;
    float acceleration_mps2 = 2.6F;  ///< Greatest usual acceleration.
    float deceleration_mps2 = 4.5F;  ///< Greatest usual (comfortable) deceleration, > 0.
    float speed_factor = 1.0F;       ///< Desired speed divided by the speed limit.
    core::RouteIndex route;
};

/// Append-only table of vehicles and routes. A row's number never changes; vehicles that left stay listed.
class Roster {
  public:
    /// Adds a vehicle, or replaces its entry. Throws std::logic_error when two ids share one key.
    void add(VehicleInfo vehicle);
    /// Interns a route: the edges in driving order, without internal edges. Equal routes get one index.
    core::RouteIndex add_route(const std::vector<core::EdgeIndex>& edges);
    /// Records that the vehicle took another route.
    void set_route(core::VehicleKey key, core::RouteIndex route);

    /// Nothing when no such vehicle was ever added. The pointer is valid until the next `add`.
    const VehicleInfo* find(core::VehicleKey key) const;
    const std::vector<core::EdgeIndex>& route(core::RouteIndex index) const { return routes_[index.value]; }
    const std::vector<VehicleInfo>& vehicles() const { return vehicles_; }
    std::size_t route_count() const { return routes_.size(); }

  private:
    std::vector<VehicleInfo> vehicles_;
    std::unordered_map<core::VehicleKey, std::uint32_t> row_of_;
    std::vector<std::vector<core::EdgeIndex>> routes_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> routes_by_hash_;
};

}  // namespace clearway::traffic
