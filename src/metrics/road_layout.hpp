#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/ids.hpp"

namespace clearway::metrics {

/// An edge on which vehicles wait: one that ends at a signal, or any edge in a network without signals. Edges
/// with counted flows are approaches too.
struct Approach {
    std::string edge;
    core::SignalIndex signal;  ///< None for an edge without a signal.
};

/// A stop line on the route of an emergency vehicle.
struct RouteSignal {
    core::SignalIndex signal;
    std::string id;
    std::vector<std::uint16_t> links;  ///< The vehicle may pass when any of them is green.
    double distance_m = 0.0;           ///< From the start of the route.
    /// When the vehicle could be there, at the speed limits from its planned departure on.
    double earliest_s = 0.0;
    std::int32_t approach = -1;  ///< Index of its own approach; -1 for none.
};

/// The route of an emergency vehicle, as distances.
struct WatchedRoute {
    core::VehicleKey vehicle;
    std::string id;
    std::vector<std::string> edges;      ///< By position in the route.
    std::vector<double> edge_start_m;    ///< By position in the route, junctions included.
    std::vector<double> edge_length_m;   ///< Likewise.
    std::vector<std::int32_t> approach;  ///< Likewise; index of the approach, -1 for none.
    std::vector<RouteSignal> signals;    ///< In driving order.
};

/// A signal-controlled path across a junction, identified by the lanes that a vehicle uses.
struct SignalWay {
    core::LaneIndex to;    ///< First internal lane of the path, or the lane after it.
    core::LaneIndex from;  ///< The lane before the path if `to` is the lane after it; else none.
    core::SignalIndex signal;
    std::uint16_t link = 0;
};

/// A link of a signal, as the event log names it (roads/signal_numbers.hpp).
struct SignalHead {
    std::uint32_t phase = 0;     ///< Signal group; 0 for a link that controls nothing.
    std::uint32_t approach = 0;  ///< Number of the pre-empt; 0 for crossings.
    bool on_foot = false;
    std::vector<std::uint16_t> foes;  ///< Links that conflict with it.
};

/// A way from the end of a lane, inside junctions too.
struct LaneWay {
    core::EdgeIndex next;  ///< Edge of `to`.
    core::LaneIndex
        onto;  ///< The lane that a vehicle drives on next: the first inside the junction, or `to`.
    core::SignalIndex signal;  ///< Or none.
    std::uint16_t link = 0;
};

/// The lanes as vehicles follow each other on them, all by core::LaneIndex.
struct LaneChain {
    std::vector<std::vector<LaneWay>> ways;
    std::vector<core::EdgeIndex> edge;
    std::vector<float> length_m;
    /// The edge outside junctions: of a lane inside one, the edge that leads there.
    std::vector<core::EdgeIndex> approach;
    /// By core::EdgeIndex: its id, the junction at its end, and the crossings for pedestrians there.
    std::vector<std::string> edge_ids;
    std::vector<std::string> junctions;
    std::vector<std::vector<core::LaneIndex>> crossings;
    /// By core::LaneIndex, of a lane inside a junction: lanes inside it whose ways cross or join the way over
    /// this lane, and the lanes from which ways start that go before it.
    std::vector<std::vector<core::LaneIndex>> foes;
    std::vector<std::vector<core::LaneIndex>> prior;
};

/// What a recorder has to know of the map to say where time was lost: plain numbers, so that it needs no map.
struct RoadLayout {
    static constexpr std::int32_t no_approach = -1;

    std::vector<Approach> approaches;
    std::vector<std::int32_t> approach_of_lane;  ///< By core::LaneIndex; `no_approach` for others.
    std::vector<std::uint8_t> internal_lane;     ///< By core::LaneIndex; 1 inside junctions.
    std::vector<float> limit_of_lane_mps;        ///< By core::LaneIndex.
    std::vector<WatchedRoute> routes;
    /// Describes the way that the vehicle of a route took instead; earliest times count from 0 s. Empty where
    /// ways do not change.
    std::function<WatchedRoute(const RoadLayout&, const WatchedRoute&, std::span<const core::EdgeIndex>)>
        on_way;
    std::vector<std::string> signals;                   ///< Ids, by core::SignalIndex.
    std::vector<SignalWay> signal_ways;                 ///< Ordered by `to`.
    std::vector<std::vector<SignalHead>> signal_heads;  ///< By core::SignalIndex, then link.
    LaneChain chain;
    /// Vehicles of the demand depart until this time; flows are measured until then.
    double demand_until_s = 0.0;
    /// Whether to keep the emergency vehicles' journeys, which take as much space as everything else
    /// together.
    bool keep_journeys = false;
};

}  // namespace clearway::metrics
