#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "core/random.hpp"
#include "roads/fastest_routes.hpp"
#include "roads/reach.hpp"
#include "scenario/detail/demand.hpp"

namespace clearway::scenario::detail {

/// Draws the ends of trips where not all edges reach each other. The weight of an edge is its share of the
/// total length, plus, where traffic can only enter (or leave) the network, its share of the lanes of all
/// such edges.
class ReachableEnds {
  public:
    /// `edges`: those on which trips may start and end, ascending, not empty.
    ReachableEnds(const roads::Network& network, std::vector<core::EdgeIndex> edges);

    /// Where a trip starts, by a uniform number in [0, 1).
    core::EdgeIndex origin(double uniform) const;
    /// The other end of a trip that starts at `end` (way onward) or ends there (way back), but not `end`
    /// itself; `none` if there is none.
    core::EdgeIndex other_end(core::EdgeIndex end, roads::Way way, double uniform) const;

  private:
    roads::Reach reach_;
    std::vector<core::EdgeIndex> edges_;
    std::vector<double> from_weight_, to_weight_;  ///< By row of edges_.
};

using RouteEdges = std::vector<core::EdgeIndex>;

/// Shortest allowed length of a vehicle's route, and the key that sets it.
struct LeastLength {
    const char* key = "";  ///< `trips.minimum_length_m`
    double metres = 0.0;
};

/// Whether class `emergency` may drive the whole route.
bool open_to_emergency(const roads::Network& network, const RouteEdges& route);

/// Trips over the whole network: the ends are drawn, weighted by edge length, until the fastest route is long
/// enough and makes no U-turn, because nobody starts in the wrong direction. With `trips.ends` = reachable,
/// one end is drawn among the edges that the other leads to or comes from, and half of the weight is on edges
/// where traffic can only enter (or only leave) the network, by number of lanes, so that short ramps are used
/// too.
class TripRoutes {
  public:
    /// Throws core::InputError when no edge is left for trips, and for sites at edges that do not exist.
    explicit TripRoutes(const DemandContext& context);

    /// Route of a human or automated vehicle. Throws core::InputError when the draws find none.
    RouteEdges traffic(const std::string& id);
    /// Route of an emergency vehicle. If the scenario has sites, it goes from a station to a place or from a
    /// place to a hospital (fire engines always start at a station); otherwise it is drawn like traffic.
    RouteEdges emergency(const std::string& id, traffic::VehicleKind kind, const LeastLength& least);

  private:
    struct Ends {
        core::EdgeIndex from;
        core::EdgeIndex to;
    };
    template <class DrawEnds>
    RouteEdges search(const LeastLength& least, bool for_emergency, const DrawEnds& draw);
    struct Draw {
        core::Purpose purpose;
        const std::string& id;  ///< Of the vehicle.
        std::uint64_t counter;
    };
    Ends two_places(core::Purpose purpose, const std::string& id, std::uint64_t counter) const;
    /// The end of a trip whose first end is `end`.
    core::EdgeIndex other_place(core::EdgeIndex end, roads::Way way, const Draw& draw) const;
    core::EdgeIndex place(const Draw& draw) const;
    double uniform(const Draw& draw) const;
    core::EdgeIndex site(const std::vector<core::EdgeIndex>& sites, const std::string& id,
                         std::uint64_t counter) const;
    bool too_far(const Ends& ends) const;
    void read_sites();

    const DemandContext& context_;
    roads::FastestRoutes fastest_;
    std::vector<core::EdgeIndex> edges_;
    std::vector<double> reached_m_;
    std::optional<ReachableEnds> reachable_;
    std::vector<core::EdgeIndex> stations_, fire_stations_, hospitals_;
};

}  // namespace clearway::scenario::detail
