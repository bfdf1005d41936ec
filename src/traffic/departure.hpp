#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/spellings.hpp"
#include "core/units.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::traffic {

/// SUMO's `device.bluelight` of an emergency vehicle: it passes red, and others form a rescue lane ahead of
/// it.
enum class BlueLight : std::uint8_t { off, on };
constexpr core::Spellings<BlueLight, 2> spellings(BlueLight) {
    return {{{BlueLight::off, "off"}, {BlueLight::on, "on"}}};
}

/// An emergency vehicle that a run adds after the warm-up.
struct EmergencyDeparture {
    std::string id;
    std::string type;  ///< SUMO vehicle type, defined in the scenario's files.
    VehicleKind kind = VehicleKind::ambulance;
    std::vector<std::string> edges;  ///< Route, by edge id, internal edges left out.
    core::Seconds depart;
    std::string depart_lane = "best";
    std::string depart_speed = "max";
    BlueLight bluelight = BlueLight::off;
    double rerouting_s = 0.0;  ///< Period of SUMO's `device.rerouting`; 0: none.
    /// Where the trip ends on the last edge, from its start; nothing: at its end.
    std::optional<core::Metres> arrival = {};
    /// A call sends it: from where, and on which way, is decided in the run.
    bool is_called = false;
};

/// Parameters of a SUMO vehicle type (`<param key= value=/>`) that a scenario writes and the gateway reads
/// back. A type without them is human and of kind other.
inline constexpr const char* class_parameter = "clearway.class";
inline constexpr const char* kind_parameter = "clearway.kind";

}  // namespace clearway::traffic
