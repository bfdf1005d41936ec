#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "traffic/incident.hpp"

namespace clearway::roads {
class Network;
}

namespace clearway::scenario {

struct ScenarioConfig;

/// One of `[[incident]]`: a road that is blocked for a while, the same in every condition. Solo runs have
/// none.
struct Incident {
    std::string edge;
    std::optional<double> longitude;
    std::optional<double> latitude;
    std::string lanes;
    std::optional<double> position_m;
    double from_s = 0.0;
    std::optional<double> to_s;
    std::optional<double> known_after_s;
    double speed_past_kmh = 0.0;
    int emergency_passes = 0;
    double reroute_share = 0.0;

    static constexpr void fields(const auto& table) {
        using S = Incident;
        table(
            core::Field{"edge", "", &S::edge, 0, 0, "Edge that it blocks, or give coordinates.", "scenario"},
            core::Field{"longitude", "deg", &S::longitude, -180.0, 180.0,
                        "With latitude: on the nearest road open to cars.", "none: edge"},
            core::Field{"latitude", "deg", &S::latitude, -90.0, 90.0, "WGS 84, as longitude.", "none: edge"},
            core::Field{"lanes", "", &S::lanes, 0, 0, "Closed lanes, 0 outermost, with blanks between.",
                        "empty: all lanes for cars"},
            core::Field{"position_m", "m", &S::position_m, 0.0, 1e6, "From the start of the edge.",
                        "none: its middle, or the coordinates"},
            core::Field{"from_s", "s", &S::from_s, 0.0, 604800.0, "When it begins.", "0: from the start"},
            core::Field{"to_s", "s", &S::to_s, 0.0, 604800.0, "When it is over.", "none: time.horizon_s"},
            core::Field{"known_after_s", "s", &S::known_after_s, 0.0, 604800.0,
                        "After from_s, all know of it.",
                        "none: when an AV or EV with a working sensor comes within 50 m"},
            core::Field{"speed_past_kmh", "km/h", &S::speed_past_kmh, 0.0, 400.0,
                        "Limit on the open lanes meanwhile; 0: none.", "0"},
            core::Field{"emergency_passes", "1", &S::emergency_passes, 0, 1,
                        "1: closed for all but EVs, without an obstacle.", "0: vehicles stand there"},
            core::Field{"reroute_share", "1", &S::reroute_share, 0.0, 1.0,
                        "Share of the other drivers that take another way once it is known.", "0"});
    }
};

/// An incident on a network, and what other drivers do.
struct PlacedIncident {
    traffic::Incident closed;
    double reroute_share = 0.0;  ///< Of them: who takes another way once it is known.
    std::size_t row = 0;         ///< In the file.
};

/// The rows of the incidents that last on an edge at a moment, if they close it to emergency vehicles, alone
/// or together; else none.
std::set<std::size_t> closing_rows(const roads::Network& network,
                                   const std::vector<PlacedIncident>& incidents, core::EdgeIndex edge,
                                   double at_s);

/// The incidents of a scenario on its network, in the order of the file. Throws core::InputError with every
/// problem: an unknown edge or lane, coordinates off the network or without a projection, an edge closed to
/// emergency vehicles, a position beyond the edge, a limit past it with no lane open, two incidents on one
/// lane at a time, and incidents that together close the only way out of a station, of the start of an
/// emergency vehicle's trip, or of a flow.
std::vector<PlacedIncident> place_incidents(const ScenarioConfig& config, const roads::Network& network);

}  // namespace clearway::scenario
