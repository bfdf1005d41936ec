#pragma once

#include <span>
#include <vector>

#include "core/units.hpp"
#include "policy/detail/approach.hpp"
#include "policy/detail/believed_ways.hpp"
#include "policy/detail/view.hpp"
#include "python/sheet.hpp"

namespace clearway::policy::detail {

/// A believed graph in memory that a Python process shares. The first columns are the members of
/// traffic::BelievedGraph; those from `ahead_first` on are what View and `approaches` say of it, so that no
/// policy in Python walks routes itself. Lists of lists are flat, with the bounds of each in `*_first`.
std::span<const python::Column> belief_columns();

/// How far ahead of an emergency vehicle sheets tell vehicles, m: twice as far as ClearLane acts.
inline constexpr core::Metres sheet_horizon{300.0};
/// The same for signals: as far as PreemptSignals looks.
inline constexpr core::Metres approach_horizon{600.0};

/// Writes the sheet of a belief that `ways` has seen. Allocates what View allocates.
void write_belief(const View& view, const std::vector<traffic::BelievedVehicle>& emergency,
                  const BelievedWays& ways, python::Sheet& sheet);

}  // namespace clearway::policy::detail
