#include "traffic/emergency_ends.hpp"

#include <fmt/format.h>

namespace clearway::traffic {
namespace {

/// Where all but fire engines start.
std::string stations_of(const EmergencyEnds& ends) {
    if (ends.ambulance_stations && ends.fire_stations) return "ambulance and fire stations";
    return ends.ambulance_stations ? "ambulance stations"
           : ends.fire_stations    ? "fire stations"
                                   : "hospitals";
}

std::string ways_of(const EmergencyEnds& ends) {
    if (!ends.hospitals && !ends.ambulance_stations && !ends.fire_stations)
        return "EVs drive between random places";
    const std::string stations = stations_of(ends);
    const bool has_others = ends.ambulances || ends.police_cars;
    std::string text;
    if (has_others)
        text = fmt::format(
            "{} drive half from {}{} to random places and half from random places to {}{}",
            ends.fire_engines ? "EVs other than fire engines" : "EVs", stations,
            ends.ambulances && !ends.ambulance_stations ? " (no ambulance station is known)" : "",
            ends.hospitals ? "hospitals" : stations, ends.hospitals ? "" : " (no hospital is known)");
    if (ends.fire_engines)
        text += fmt::format("{}fire engines{} from {}{} to random places", has_others ? ", " : "",
                            has_others ? "" : " drive", ends.fire_stations ? "fire stations" : stations,
                            ends.fire_stations ? "" : " (no fire station is known)");
    return text;
}

}  // namespace

bool EmergencyEnds::has_stand_in() const {
    const bool has_sites = hospitals || ambulance_stations || fire_stations;
    return has_sites && ((ambulances && !ambulance_stations) || (fire_engines && !fire_stations));
}

std::string words(const EmergencyEnds& ends) {
    return ways_of(ends) +
           (ends.least_m > 0.0 ? fmt::format(", on routes of at least {:g} m", ends.least_m) : "");
}

}  // namespace clearway::traffic
