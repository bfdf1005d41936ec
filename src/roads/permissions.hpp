#pragma once

#include "core/xml_stream.hpp"

namespace clearway::roads {

/// Which of the relevant SUMO classes may use a lane or a connection.
struct Permissions {
    bool cars = true;       ///< vClass passenger.
    bool emergency = true;  ///< vClass emergency.
    bool pedestrians = true;
};

/// SUMO's rule: if there is an `allow`, it alone counts; otherwise every class may pass but those in
/// `disallow`.
Permissions permissions_of(const core::XmlAttributes& attributes);

}  // namespace clearway::roads
