#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roads/network.hpp"
#include "view/stream_config.hpp"

namespace clearway::view {

/// Adds where a vehicle drove in a recorded run, one point a step. Throws as trace::RecordingReader does.
void add_path(const std::filesystem::path& recording, const std::string& vehicle,
              std::vector<roads::Point>& path);

/// The places within some `radius_m` of the points of a path, in cells of 25 m: a place is shown or not as
/// the middle of its cell. The points of a path are less than a cell apart for vehicles slower than 50 m/s.
Area near_path(const std::vector<roads::Point>& path, double radius_m);

}  // namespace clearway::view
