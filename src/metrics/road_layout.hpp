#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.hpp"

namespace clearway::metrics {

/// Lanes that lead to one place where vehicles wait: an edge that ends at a signal; in a network without
/// signals, any edge. Edges that have counted flows are approaches too.
struct Approach {
    std::string edge;
    core::SignalIndex signal;  ///< Or none.
};

/// A stop line on the route of an emergency vehicle.
struct RouteSignal {
    core::SignalIndex signal;
    std::string id;
    std::vector<std::uint16_t> links;  ///< Any of which lets the vehicle pass.
    double distance_m = 0.0;           ///< From the start of the route.
};

/// The route of an emergency vehicle as distances.
struct WatchedRoute {
    core::VehicleKey vehicle;
    std::string id;
    std::vector<double> edge_start_m;    ///< By place in the route, ways across junctions counted.
    std::vector<double> edge_length_m;   ///< Likewise.
    std::vector<std::int32_t> approach;  ///< Likewise; index of the approach, -1 for none.
    std::vector<RouteSignal> signals;    ///< In driving order.
};

/// A way across a junction that a signal controls, as a vehicle's lanes show it.
struct SignalWay {
    core::LaneIndex to;    ///< First inner lane of the way, or the lane behind it.
    core::LaneIndex from;  ///< The lane before it where `to` is the lane behind, else none.
    core::SignalIndex signal;
    std::uint16_t link = 0;
};

/// What a recorder has to know of the map to say where time was lost: numbers alone, so that it needs no map.
struct RoadLayout {
    static constexpr std::int32_t no_approach = -1;

    std::vector<Approach> approaches;
    std::vector<std::int32_t> approach_of_lane;  ///< By core::LaneIndex; `no_approach` for others.
    std::vector<std::uint8_t> internal_lane;     ///< By core::LaneIndex; 1 inside junctions.
    std::vector<float> limit_of_lane_mps;        ///< By core::LaneIndex.
    std::vector<WatchedRoute> routes;
    std::vector<SignalWay> signal_ways;  ///< Ordered by `to`.
    double demand_until_s =
        0.0;  ///< Vehicles of the demand depart up to this time; flows are taken until then.
    /// Whether the emergency vehicles' journeys are kept; they are as large as everything else together.
    bool keep_journeys = false;
};

}  // namespace clearway::metrics
