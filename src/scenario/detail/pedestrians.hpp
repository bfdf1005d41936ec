#pragma once

#include <string>

#include "scenario/detail/demand.hpp"

namespace clearway::scenario::detail {

/// Route file of the persons `pedestrian.0`, ..., by departure. Each departs near one side of a crossing and
/// walks to a place near the other side, on one of the sidewalks there, at its own speed. Throws
/// core::InputError when the network has no such crossing.
std::string pedestrians_xml(const DemandContext& context);

}  // namespace clearway::scenario::detail
