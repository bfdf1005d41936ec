#pragma once

#include <cstddef>
#include <filesystem>

#include "core/units.hpp"
#include "roads/network.hpp"
#include "trace/recording.hpp"

namespace clearway::trace {

/// What to write of a recorded run.
struct TrajectoryOptions {
    core::Seconds every{1.0};  ///< Time between two places of a vehicle, at least one step.
    core::Metres reach{50.0};  ///< Vehicles nearer than this to an emergency vehicle are its neighbours.
};

/// What was written.
struct TrajectoryCounts {
    std::size_t emergency_vehicles = 0;
    std::size_t neighbours = 0;
    std::size_t places = 0;  ///< Rows of the CSV file.
    bool has_coordinates = false;
};

/// Writes into `folder` where the emergency vehicles of a recording drove and which vehicles were near them:
/// trajectories.csv, one row per vehicle and time (time_s, vehicle, class, near, distance_m, longitude_deg,
/// latitude_deg, x_m, y_m, speed_mps, lane; the row of an emergency vehicle has no `near`), and
/// trajectories.geojson (RFC 7946, WGS 84): one LineString per vehicle and stretch of time without a gap,
/// with its times. When the network has no known projection, the coordinates are empty and no GeoJSON is
/// written. A LineString needs two places, so shorter stretches are omitted. Throws as RecordingReader does.
TrajectoryCounts write_trajectories(RecordingReader& recording, const roads::Network& network,
                                    const TrajectoryOptions& options, const std::filesystem::path& folder);

}  // namespace clearway::trace
