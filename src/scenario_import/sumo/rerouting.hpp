#pragma once

namespace clearway::scenario_import::detail {

struct Demand;

/// Who chooses new ways by the traffic of the moment, as a configuration says: SUMO's routing device.
struct Rerouting {
    double share = 0.0;     ///< Of all vehicles (`device.rerouting.probability`), drawn by their ids.
    double period_s = 0.0;  ///< These choose again so often on their way; 0: only at departure.
};

/// Gives SUMO's routing device to vehicles of that share. Trips between two edges without vias get SUMO's
/// mark of a trip: they keep the way that they have, and SUMO chooses again when they depart.
void add_routing_devices(Demand& demand, const Rerouting& rerouting);

}  // namespace clearway::scenario_import::detail
