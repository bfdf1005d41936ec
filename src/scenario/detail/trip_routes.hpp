#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "core/random.hpp"
#include "scenario/detail/demand.hpp"

namespace clearway::scenario::detail {

using RouteEdges = std::vector<core::EdgeIndex>;

/// Shortest route that a vehicle may get, and the key that says so.
struct LeastLength {
    const char* key = "";  ///< `trips.minimum_length_m`
    double metres = 0.0;
};

/// Whether class `emergency` may drive the whole route.
bool open_to_emergency(const roads::Network& network, const RouteEdges& route);

/// Trips over the whole network: ends drawn by length of edge until the fastest way is long enough and does
/// not turn round, for nobody sets out in the wrong direction.
class TripRoutes {
  public:
    /// Throws core::InputError when no edge is left for trips, and for sites at edges that are none.
    explicit TripRoutes(const DemandContext& context);

    /// Of a human or automated vehicle. Throws core::InputError when the draws find none.
    RouteEdges traffic(const std::string& id) const;
    /// Of an emergency vehicle: from a station to a place, or from a place to a hospital, where the scenario
    /// has sites (fire engines always from a station); else like traffic.
    RouteEdges emergency(const std::string& id, traffic::VehicleKind kind, const LeastLength& least) const;

  private:
    struct Ends {
        core::EdgeIndex from;
        core::EdgeIndex to;
    };
    template <class DrawEnds>
    RouteEdges search(const LeastLength& least, bool for_emergency, const DrawEnds& draw) const;
    core::EdgeIndex place(core::Purpose purpose, const std::string& id, std::uint64_t counter) const;
    core::EdgeIndex site(const std::vector<core::EdgeIndex>& sites, const std::string& id,
                         std::uint64_t counter) const;
    bool too_far(const Ends& ends) const;
    void read_sites();

    const DemandContext& context_;
    std::vector<core::EdgeIndex> edges_;
    std::vector<double> reached_m_;
    std::vector<core::EdgeIndex> stations_, fire_stations_, hospitals_;
};

}  // namespace clearway::scenario::detail
