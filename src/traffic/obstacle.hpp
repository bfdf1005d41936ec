#pragma once

namespace clearway::traffic {

/// Ids in SUMO that begin so are obstacles of incidents, which are no traffic.
inline constexpr const char* obstacle_prefix = "clearway.incident.";

}  // namespace clearway::traffic
