#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "trace/detail/hdf5.hpp"
#include "traffic/lease.hpp"
#include "traffic/observation.hpp"
#include "traffic/vehicle.hpp"
#include "truth/events.hpp"

namespace clearway::trace::detail {

// Names of enumerators in the order of their numbers, for the types of data sets.

template <class Enum, std::size_t Count>
std::array<std::string_view, Count> names_of() {
    std::array<std::string_view, Count> names;
    for (std::size_t i = 0; i < Count; ++i)
        names[i] = traffic::name(static_cast<Enum>(i));
    return names;
}

/// Which member of traffic::Action a lease holds: its index in the variant.
enum class ActionKind : std::uint8_t {};

template <std::size_t... Kind>
traffic::Action empty_action(ActionKind kind, std::index_sequence<Kind...>) {
    traffic::Action action;
    ((Kind == static_cast<std::size_t>(kind) ? (void)action.emplace<Kind>() : void()), ...);
    return action;
}
inline traffic::Action empty_action(ActionKind kind) {
    return empty_action(kind, std::make_index_sequence<std::variant_size_v<traffic::Action>>());
}

template <std::size_t... Kind>
std::array<std::string_view, sizeof...(Kind)> action_names_of(std::index_sequence<Kind...>) {
    return {traffic::name(empty_action(static_cast<ActionKind>(Kind)))...};
}

/// The kinds of event, in the order of truth::Events' members.
enum class EventKind : std::uint8_t { departed, arrived, teleported, removed, collision, emergency_braking };

inline const auto class_names = names_of<traffic::VehicleClass, traffic::vehicle_classes.size()>();
inline const auto kind_names =
    names_of<traffic::VehicleKind, static_cast<std::size_t>(traffic::VehicleKind::other) + 1>();
inline const auto action_names =
    action_names_of(std::make_index_sequence<std::variant_size_v<traffic::Action>>());
inline constexpr std::array<std::string_view, 2> freshness_names = {"fresh", "stale"};
inline constexpr std::array<std::string_view, 2> side_names = {"right", "left"};
inline constexpr std::array<std::string_view, 2> addressed_names = {"automated", "drivers"};
inline constexpr std::array<std::string_view, 2> place_names = {"lane", "junction"};
inline constexpr std::array<std::string_view, 6> event_names = {"departed", "arrived",   "teleported",
                                                                "removed",  "collision", "emergency_braking"};

// Columns that several tables have.
inline const Column vehicle_column{"vehicle", "", "Row in /vehicles"};
inline const Column class_column{"class", "", "Human, automated or emergency vehicle"};

}  // namespace clearway::trace::detail
