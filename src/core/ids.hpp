#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>

namespace clearway::core {

/// Identity of a vehicle during the whole run: a 64-bit hash of its SUMO id. It does not depend on the order
/// in which vehicles appear, so keyed random draws agree between conditions. Collisions are rejected where
/// keys are registered.
struct VehicleKey {
    std::uint64_t value = 0;
    constexpr auto operator<=>(const VehicleKey&) const = default;
};

/// Key of a vehicle by its SUMO id (FNV-1a, 64 bit, then mixed). Pure.
VehicleKey vehicle_key(std::string_view sumo_id);

/// Index of an element in its table; `none()` where there is none. Lane, edge, signal and junction indices
/// refer to `roads::Network` and are valid for a run; a route index refers to a `traffic::Roster`.
template <class Tag>
struct Index {
    std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

    static constexpr Index none() { return Index{}; }
    constexpr bool exists() const { return value != std::numeric_limits<std::uint32_t>::max(); }
    constexpr auto operator<=>(const Index&) const = default;
};

using LaneIndex = Index<struct LaneTag>;
using EdgeIndex = Index<struct EdgeTag>;
using SignalIndex = Index<struct SignalTag>;
using RouteIndex = Index<struct RouteTag>;

/// Row of a vehicle in one snapshot, observation or belief. Valid for that object alone.
using VehicleIndex = std::uint32_t;

}  // namespace clearway::core

template <>
struct std::hash<clearway::core::VehicleKey> {
    std::size_t operator()(clearway::core::VehicleKey key) const noexcept { return key.value; }
};
