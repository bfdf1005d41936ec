#pragma once

#include "metrics/road_layout.hpp"

namespace clearway::metrics::detail {

/// The path across a junction that a vehicle has entered which was on lane `from` and is on `to` one step
/// later; null if it has entered none. A path is identified by its first internal lane, or by the lanes
/// before and after it when the vehicle crossed it within one step.
const SignalWay* signal_way(const RoadLayout& layout, core::LaneIndex from, core::LaneIndex to);

}  // namespace clearway::metrics::detail
