#pragma once

#include "core/xml_stream.hpp"

namespace clearway::roads::detail {

/// Who of those that matter here may use a lane or a connection.
struct Permissions {
    bool cars = true;       ///< vClass passenger.
    bool emergency = true;  ///< vClass emergency.
    bool pedestrians = true;
};

/// SUMO's rule: `allow` alone counts when it is there, else everybody but those of `disallow`.
Permissions permissions_of(const core::XmlAttributes& attributes);

}  // namespace clearway::roads::detail
