#include "sumo/detail/fleet.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::sumo::detail {
namespace {

void insert_sorted(std::vector<Vehicle*>& vehicles, Vehicle& vehicle, auto member) {
    vehicles.insert(std::ranges::lower_bound(
                        vehicles, vehicle.*member,
                        {}, [&](const Vehicle* other) -> const auto& { return other->*member; }),
                    &vehicle);
}

void erase_sorted(std::vector<Vehicle*>& vehicles, const Vehicle& vehicle, auto member) {
    vehicles.erase(std::ranges::lower_bound(
        vehicles, vehicle.*member, {}, [&](const Vehicle* other) -> const auto& { return other->*member; }));
}

}  // namespace

Vehicle& Fleet::insert(const std::string& id) {
    const core::VehicleKey key = core::vehicle_key(id);
    Vehicle& vehicle = vehicles_[key];
    assert((vehicle.id.empty() || vehicle.id == id) && "two ids with one key");
    vehicle.id = id;
    vehicle.key = key;
    return vehicle;
}

void Fleet::erase(const std::string& id) {
    Vehicle* vehicle = find(id);
    if (vehicle == nullptr) return;
    take_off_road(*vehicle);
    vehicles_.erase(vehicle->key);
}

void Fleet::put_on_road(Vehicle& vehicle) {
    if (vehicle.on_road) return;
    vehicle.on_road = true;
    insert_sorted(by_id_, vehicle, &Vehicle::id);
    insert_sorted(by_key_, vehicle, &Vehicle::key);
    rows_are_stale_ = true;
}

void Fleet::take_off_road(Vehicle& vehicle) {
    if (!vehicle.on_road) return;
    vehicle.on_road = false;
    erase_sorted(by_id_, vehicle, &Vehicle::id);
    erase_sorted(by_key_, vehicle, &Vehicle::key);
    rows_are_stale_ = true;
}

Vehicle* Fleet::find(std::string_view id) {
    return find(core::vehicle_key(id));
}

Vehicle* Fleet::find(core::VehicleKey key) {
    const auto found = vehicles_.find(key);
    return found == vehicles_.end() ? nullptr : &found->second;
}

void Fleet::number_rows() {
    if (!rows_are_stale_) return;
    for (std::uint32_t row = 0; row < by_key_.size(); ++row) {
        by_key_[row]->row = row;
    }
    rows_are_stale_ = false;
    assert(by_id_.size() == by_key_.size());
}

}  // namespace clearway::sumo::detail
