#pragma once

#include <string>

namespace clearway::traffic {

/// What drawn trips of emergency vehicles begin and end at: the kinds of sites that there are, and the kinds
/// of vehicles that are drawn.
struct EmergencyEnds {
    bool hospitals = false;
    bool ambulance_stations = false;
    bool fire_stations = false;
    bool ambulances = true;
    bool fire_engines = false;
    bool police_cars = false;
    double least_m = 0.0;  ///< Length of their routes.

    /// Whether a kind of vehicle starts at a kind of site that is not its own.
    bool has_stand_in() const;
};

/// `EVs drive half from hospitals (no ambulance station is known) to random places and half from random
/// places to hospitals, on routes of at least 1000 m`.
std::string words(const EmergencyEnds& ends);

}  // namespace clearway::traffic
