#pragma once

namespace clearway::actuation::detail {

/// How far before the line vehicles stop, m: SUMO's own stop-line gap.
inline constexpr double stop_line_gap_m = 1.0;

}  // namespace clearway::actuation::detail
