#pragma once

#include <string_view>

namespace clearway::traffic {

/// Whether SUMO writes a file of a vehicle or a type with a parameter of this name.
inline bool lets_vehicles_write(std::string_view key) {
    return key == "has.ssm.device" || key.ends_with(".file");
}

}  // namespace clearway::traffic
