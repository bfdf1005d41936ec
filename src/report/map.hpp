#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace clearway::report {

/// A place of the network's plane, m, y up.
using MapPlace = std::pair<double, double>;

/// An edge outside junctions, as `roads.json` has it.
struct MapEdge {
    std::string id;
    std::vector<std::size_t> to;  ///< Places in RoadMap::edges of the edges that it leads to.
    bool signal = false;          ///< Whether it ends at a signal.
    double length_m = 0.0;
    double limit_mps = 0.0;
    std::vector<MapPlace> shape;

    double free_flow_s() const { return limit_mps > 0.0 ? length_m / limit_mps : 0.0; }
};

struct MapSignal {
    std::string id;
    MapPlace place;
};

/// Where emergency vehicles wait for calls.
struct MapStation {
    std::string edge;
    std::string kind;
    std::string name;  ///< Text from a file; may be empty.
};

/// A road that is blocked for a while.
struct MapIncident {
    std::string edge;
    double from_s = 0.0;  ///< After the start of the simulation.
    double to_s = 0.0;
    std::optional<double> known_after_s = {};  ///< Nothing: when a vehicle sees it.
    double spread_s = 0.0;                     ///< Each run has it later by up to this.
    bool is_closed = false;                    ///< To emergency vehicles; not said by older run folders.
};

/// A place to which emergency vehicles are called.
struct MapCall {
    std::string edge;
    double at_s = 0.0;
    std::uint64_t units = 0;
};

/// The roads of a scenario that emergency vehicles may drive.
struct RoadMap {
    std::vector<MapEdge> edges;
    std::vector<MapSignal> signals;
    std::vector<MapStation> stations;
    std::vector<MapIncident> incidents;
    std::vector<MapCall> calls;

    std::optional<std::size_t> find_edge(const std::string& id) const;
};

/// Times of emergency vehicles on an edge over all passages that baseline and condition share: same
/// replication, same vehicle.
struct EdgeTimes {
    std::size_t edge = 0;  ///< In RoadMap::edges.
    std::uint64_t passages = 0;
    double baseline_s = 0.0;   ///< Mean of a passage.
    double condition_s = 0.0;  ///< Likewise.

    double gain_s() const { return baseline_s - condition_s; }
};

/// How long a signal was held under a condition, per run.
struct SignalHolds {
    std::size_t signal = 0;  ///< In RoadMap::signals.
    double holds = 0.0;
    double held_s = 0.0;
};

/// Locks at the junction at the end of an edge, over all runs.
struct MapLocks {
    std::size_t edge = 0;  ///< In RoadMap::edges.
    std::uint64_t condition = 0;
    std::uint64_t baseline = 0;
};

/// An emergency vehicle that drove another way under a condition than under the baseline.
struct ChangedWay {
    std::string vehicle;  ///< SUMO's id; text from a file, so printers escape it.
    std::uint32_t replication = 0;
    std::vector<std::size_t> baseline;   ///< In RoadMap::edges, in driving order; not empty.
    std::vector<std::size_t> condition;  ///< Likewise.
    double baseline_s = 0.0;             ///< From the first of these edges until it was last seen.
    double condition_s = 0.0;            ///< Likewise.

    double gain_s() const { return baseline_s - condition_s; }
};

/// An edge of ways that were considered for an emergency vehicle under a condition, and not taken.
struct ConsideredEdge {
    std::string vehicle;  ///< SUMO's id; text from a file, so printers escape it.
    std::uint32_t replication = 0;
    std::size_t edge = 0;  ///< In RoadMap::edges.
    std::uint64_t decisions = 0;
};

/// Where the edge of a road network lies in time, seen from the nearest station.
struct ReachedEdge {
    std::optional<double> baseline_s;   ///< At the end of the edge; nothing if no station leads there.
    std::optional<double> condition_s;  ///< Likewise.
    bool driven = false;                ///< Whether its time was measured, not estimated.
};

/// What emergency vehicles reach from their stations, with and without a condition.
struct Reach {
    std::vector<ReachedEdge> edges;   ///< In the order of RoadMap::edges.
    std::vector<std::size_t> starts;  ///< Edges of the stations.
    double minutes = 0.0;             ///< Whole ones: what the map shows.
    /// Time of the baseline on a driven edge over that at the limit. Of edges not driven it gives the time,
    /// without and with the condition: what it does is known where EVs drove alone.
    double delay = 1.0;

    /// Length of all edges that are reached within a time, m.
    double baseline_m(const RoadMap& map, double within_s) const;
    double condition_m(const RoadMap& map, double within_s) const;
};

/// Trips of the pairs of runs, and by how much later than in the baseline they end.
struct LaterArrivals {
    std::uint64_t trips = 0;
    std::vector<double>
        means_s;  ///< A pair with such trips each, because trips of one run are not independent.
};

/// Trips by whether they pass a signal.
struct SignalTrips {
    LaterArrivals passing;
    LaterArrivals others;
};

/// What the maps of a scenario show of one condition.
struct ScenarioMap {
    std::string condition;  ///< Its name; the one that the first screen is about.
    std::vector<EdgeTimes> times;
    std::vector<SignalHolds> holds;
    std::vector<MapLocks> locks = {};
    std::vector<ChangedWay> changed_ways = {};
    std::vector<ConsideredEdge> considered = {};
    std::uint64_t trips = 0;     ///< Of emergency vehicles that both runs of a pair have.
    std::optional<Reach> reach;  ///< Nothing for a scenario without stations.
    SignalTrips signal_trips = {};
};

/// Time from the nearest of `starts` to the end of each edge, both ends included (Dijkstra 1959), with the
/// seconds that each edge takes; nothing for edges that cannot be reached.
std::vector<std::optional<double>> times_from(const RoadMap& map, const std::vector<std::size_t>& starts,
                                              const std::vector<double>& edge_s);

/// From the starts, along all roads: an edge that emergency vehicles drove takes the mean of its passages;
/// any other one takes its time at the limit, lengthened as the driven ones are. `usual_trip_s` decides the
/// minutes that the map shows: the whole number next to half of it, at least one. Nothing without starts or
/// times.
std::optional<Reach> reach_of(const RoadMap& map, const std::vector<EdgeTimes>& times,
                              std::vector<std::size_t> starts, double usual_trip_s);

}  // namespace clearway::report
