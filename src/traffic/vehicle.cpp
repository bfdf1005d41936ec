#include "traffic/vehicle.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/random.hpp"

namespace clearway::traffic {
namespace {

constexpr std::array<std::string_view, 3> class_names = {"human", "automated", "emergency"};
constexpr std::array<std::string_view, 3> class_short_names = {"HV", "AV", "EV"};
constexpr std::array<std::string_view, 8> kind_names = {"car",       "van",         "truck",      "bus",
                                                        "ambulance", "fire_engine", "police_car", "other"};

template <class Enum, std::size_t N>
std::optional<Enum> find_name(const std::array<std::string_view, N>& names, std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Enum>(found - names.begin());
}

}  // namespace

std::string_view name(VehicleClass vehicle_class) {
    return class_names[static_cast<std::size_t>(vehicle_class)];
}

std::string_view short_name(VehicleClass vehicle_class) {
    return class_short_names[static_cast<std::size_t>(vehicle_class)];
}

std::string_view name(VehicleKind kind) {
    return kind_names[static_cast<std::size_t>(kind)];
}

std::optional<VehicleClass> vehicle_class_from(std::string_view name) {
    return find_name<VehicleClass>(class_names, name);
}

std::optional<VehicleKind> vehicle_kind_from(std::string_view name) {
    return find_name<VehicleKind>(kind_names, name);
}

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
