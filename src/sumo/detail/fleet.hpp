#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "sumo/detail/gateway.hpp"
#include "traffic/command.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::sumo::detail {

/// What commands have changed about a vehicle, so that it can be restored.
struct Controls {
    traffic::LaneChangeFreedom freedom = traffic::LaneChangeFreedom::normal;
    traffic::SafetyChecks checks = traffic::SafetyChecks::on;
    std::optional<std::string> usual_alignment;
    traffic::JunctionPrivilege privilege = traffic::JunctionPrivilege::none;
    std::optional<std::pair<std::string, double>> own_stop;  ///< Lane and position of a commanded stop.
};

/// A vehicle between departure and removal.
struct Vehicle {
    std::string id;
    core::VehicleKey key;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    float deceleration_mps2 = 4.5F;
    float emergency_deceleration_mps2 = 9.0F;
    bool on_road = false;   ///< False while teleported or parked.
    std::uint32_t row = 0;  ///< In the snapshot, while on the road.
    std::string route_id;
    Controls controls;

    // The last reading, and what it means.
    gateway::VehicleReading reading;
    std::string lane_id;
    core::LaneIndex lane;
    float lane_position_m = 0.0F;
    float speed_mps = 0.0F;
    std::uint32_t route_edge = 0;
    std::optional<double> opposite_of_m;  ///< On the lane of oncoming traffic: its length.
    bool braking_hard = false;
};

/// The vehicles in the network, kept up to date from SUMO's lists of departures and arrivals, which is 50
/// times cheaper than asking for all ids. Kept in two orders: by SUMO id for reading, which is faster in
/// SUMO's map, and by key for the rows of the snapshot. Pointers stay valid until `erase`.
class Fleet {
  public:
    /// Adds a vehicle, off the road. Returns the existing one when the id is known.
    Vehicle& insert(const std::string& id);
    void erase(const std::string& id);
    void put_on_road(Vehicle& vehicle);
    void take_off_road(Vehicle& vehicle);

    Vehicle* find(std::string_view id);
    Vehicle* find(core::VehicleKey key);
    /// Vehicles on the road, ordered by SUMO id.
    const std::vector<Vehicle*>& on_road() const { return by_id_; }
    /// Gives every vehicle on the road its row: its rank by key. O(n) after a change, otherwise free.
    void number_rows();
    /// Vehicles on the road, ordered by key.
    const std::vector<Vehicle*>& rows() const { return by_key_; }

  private:
    std::unordered_map<core::VehicleKey, Vehicle> vehicles_;
    std::vector<Vehicle*> by_id_;
    std::vector<Vehicle*> by_key_;
    bool rows_are_stale_ = false;
};

}  // namespace clearway::sumo::detail
