#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/units.hpp"
#include "policy/detail/approach.hpp"
#include "policy/detail/view.hpp"
#include "python/sheet.hpp"

namespace clearway::policy::detail {

/// A believed graph in memory that a Python process shares. The first columns are the members of
/// traffic::BelievedGraph; those from `ahead_first` on are what View and `approaches` say of it, so that no
/// policy in Python walks routes itself. Lists of lists are flat, with the bounds of each in `*_first`.
namespace belief_column {
enum Number : std::size_t {
    time,
    key,
    vehicle_class,
    x,
    y,
    heading,
    speed,
    lane,
    lane_position,
    route_edge,
    sigma,
    age,
    link_first,
    link_neighbour,
    link_distance,
    link_probability,
    emergency_key,
    emergency_x,
    emergency_y,
    emergency_heading,
    emergency_speed,
    emergency_lane,
    emergency_lane_position,
    emergency_allowed_speed,
    ahead_first,
    ahead_row,
    ahead_distance,
    ahead_usable_lower,
    ahead_usable_higher,
    approach_first,
    approach_signal,
    approach_distance,
    own_link_first,
    own_link,
    served_link_first,
    served_link,
    signal_first,
    signal_letters,
    count,
};
}  // namespace belief_column

/// In the order of belief_column.
std::span<const python::Column> belief_columns();

/// How far ahead of an emergency vehicle sheets tell vehicles, m: twice as far as ClearLane acts.
inline constexpr core::Metres sheet_horizon{300.0};
/// The same for signals: as far as PreemptSignals looks.
inline constexpr core::Metres approach_horizon{600.0};

/// Writes the sheet of a belief. Allocates what View allocates.
void write_belief(const View& view, const std::vector<traffic::BelievedVehicle>& emergency,
                  python::Sheet& sheet);

}  // namespace clearway::policy::detail
