#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/ids.hpp"
#include "core/spellings.hpp"
#include "core/units.hpp"
#include "roads/lane_grid.hpp"
#include "roads/network.hpp"
#include "traffic/emergency_ends.hpp"

namespace clearway::scenario {

struct ScenarioConfig;
struct Trips;

/// A place that emergency vehicles start from or drive to.
enum class SiteKind { hospital, ambulance_station, fire_station };

/// Spelling of each enumerator in files.
constexpr core::Spellings<SiteKind, 3> spellings(SiteKind) {
    return {{{SiteKind::hospital, "hospital"},
             {SiteKind::ambulance_station, "ambulance_station"},
             {SiteKind::fire_station, "fire_station"}}};
}

/// One of `[[emergency_site]]`: where emergency vehicles of trips and of measured demand start or arrive.
struct EmergencySite {
    SiteKind kind = SiteKind::hospital;
    std::string edge;
    std::optional<double> longitude;
    std::optional<double> latitude;
    std::string name;
    std::optional<int> units;

    /// Vehicles that calls can send from here.
    int ready() const { return units.value_or(kind == SiteKind::hospital ? 0 : 1); }

    static constexpr void fields(const auto& table) {
        using S = EmergencySite;
        table(
            core::Field{"kind", "", &S::kind, 0, 0, "hospital, ambulance_station or fire_station.",
                        "scenario"},
            core::Field{"edge", "", &S::edge, 0, 0, "Edge at which it lies, or give coordinates.",
                        "scenario"},
            core::Field{"longitude", "deg", &S::longitude, -180.0, 180.0,
                        "With latitude: at the nearest road within 300 m that trips can use.", "none: edge"},
            core::Field{"latitude", "deg", &S::latitude, -90.0, 90.0, "WGS 84, as longitude.", "none: edge"},
            core::Field{"name", "", &S::name, 0, 0, "Its name on the map; text from a file.", "none"},
            core::Field{"units", "1", &S::units, 0, 1000,
                        "Vehicles that wait here for calls; each goes once.", "stations 1, hospitals 0"});
    }
};

/// Of the emergency vehicles that are drawn.
traffic::EmergencyEnds emergency_ends(const ScenarioConfig& config);

/// The edges on which trips may start and end, as `trips.ends` and `trips.minimum_edge_m` say, ascending.
std::vector<core::EdgeIndex> trip_edges(const roads::Network& network, const Trips& trips);

/// The edges at which sites may lie: those of trips. If trip ends are only `reachable`, stations need an edge
/// that leads on and hospitals one that can be reached; if there is only one of the two, its sites need both.
/// Keeps a reference to the network.
class SiteRoads {
  public:
    /// A site lies within this distance of its road.
    static constexpr core::Metres reach{300.0};

    /// `kinds`: of all sites.
    SiteRoads(const roads::Network& network, const Trips& trips, std::span<const SiteKind> kinds);

    /// The nearest of them within reach; `none` if there is none.
    core::EdgeIndex nearest(SiteKind kind, roads::Point place) const;
    /// Whether any road open to cars is within reach.
    bool is_near_road(roads::Point place) const;

  private:
    template <class Fits>
    core::EdgeIndex nearest_where(roads::Point place, const Fits& fits) const;

    const roads::Network& network_;
    roads::LaneGrid lanes_;
    std::vector<core::EdgeIndex> stations_, hospitals_;  ///< Ascending.
};

/// The edge of each site, in the order of the file; `none` after adding a problem, for an edge that does not
/// exist and coordinates without a road in reach or in a network without a projection.
std::vector<core::EdgeIndex> site_edges(const ScenarioConfig& config, const roads::Network& network,
                                        std::vector<core::Problem>& problems);

}  // namespace clearway::scenario
