#include "traffic/vehicle.hpp"

#include <stdexcept>

#include "core/random.hpp"

namespace clearway::traffic {
void Roster::add(VehicleInfo vehicle) {
    const auto [entry, is_new] =
        row_of_.try_emplace(vehicle.key, static_cast<std::uint32_t>(vehicles_.size()));
    if (is_new) {
        vehicles_.push_back(std::move(vehicle));
        return;
    }
    VehicleInfo& known = vehicles_[entry->second];
    if (known.id != vehicle.id)
        throw std::logic_error("vehicles " + known.id + " and " + vehicle.id + " share one key");
    known = std::move(vehicle);
}

core::RouteIndex Roster::add_route(const std::vector<core::EdgeIndex>& edges) {
    std::uint64_t hash = edges.size();
    for (const core::EdgeIndex edge : edges) {
        hash = core::mix64(hash ^ edge.value);
    }
    std::vector<std::uint32_t>& same_hash = routes_by_hash_[hash];
    for (const std::uint32_t row : same_hash) {
        if (routes_[row] == edges) return core::RouteIndex{row};
    }
    const auto row = static_cast<std::uint32_t>(routes_.size());
    routes_.push_back(edges);
    same_hash.push_back(row);
    return core::RouteIndex{row};
}

void Roster::set_route(core::VehicleKey key, core::RouteIndex route) {
    vehicles_[row_of_.at(key)].route = route;
}

const VehicleInfo* Roster::find(core::VehicleKey key) const {
    const auto found = row_of_.find(key);
    return found == row_of_.end() ? nullptr : &vehicles_[found->second];
}

}  // namespace clearway::traffic
