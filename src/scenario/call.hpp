#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"
#include "core/ids.hpp"
#include "core/units.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::core {
class KeyedRandom;
}
namespace clearway::roads {
class Network;
}

namespace clearway::scenario {

struct ScenarioConfig;
struct PlacedIncident;

/// One of `[[call]]`: emergency vehicles are sent to a place. They wait at sites with `units`.
struct Call {
    std::string edge;
    std::optional<double> longitude;
    std::optional<double> latitude;
    std::optional<int> incident;
    std::optional<double> position_m;
    std::optional<double> at_s;
    double spread_s = 0.0;
    int units = 1;
    std::string kind = "ambulance";
    double turnout_s = 60.0;

    static constexpr void fields(const auto& table) {
        using S = Call;
        table(
            core::Field{"edge", "", &S::edge, 0, 0, "Where they are needed, or give coordinates or incident.",
                        "scenario"},
            core::Field{"longitude", "deg", &S::longitude, -180.0, 180.0,
                        "With latitude: at the nearest road open to cars.", "none: edge"},
            core::Field{"latitude", "deg", &S::latitude, -90.0, 90.0, "WGS 84, as longitude.", "none: edge"},
            core::Field{"incident", "1", &S::incident, 0, 10000,
                        "At this `[[incident]]`, 0 for the first: they stop before it.", "none: edge"},
            core::Field{"position_m", "m", &S::position_m, 0.0, 1e6, "From the start of the edge.",
                        "none: its middle, or the coordinates"},
            core::Field{"at_s", "s", &S::at_s, 0.0, 604800.0, "When the call comes in.",
                        "none: when everybody knows of the incident"},
            core::Field{"spread_s", "s", &S::spread_s, 0.0, 86400.0,
                        "It comes in up to this much later, by the seed.", "0"},
            core::Field{"units", "1", &S::units, 1, 100, "How many are sent.", "1"},
            core::Field{"kind", "", &S::kind, 0, 0,
                        "ambulance, from ambulance stations and hospitals, or fire_engine, from fire "
                        "stations.",
                        "ambulance"},
            core::Field{"turnout_s", "s", &S::turnout_s, 0.0, 3600.0, "From the call to the departure.",
                        "assumed"});
    }
};

/// With which the ids of called vehicles begin.
inline constexpr std::string_view called_prefix = "emergency.call.";

/// A call on a network.
struct PlacedCall {
    std::string id;  ///< `emergency.call.0`, by row in the file; that of its first vehicle ends in `.0`.
    core::EdgeIndex edge;
    float position_m = 0.0F;  ///< Where the trip ends, from the start of the edge.
    core::Seconds at;
    core::Seconds spread{0.0};  ///< It comes in from `at` on, before this has passed.
    core::Seconds turnout;
    traffic::VehicleKind kind = traffic::VehicleKind::ambulance;
    std::uint32_t units = 1;
    bool before_incident = false;  ///< An incident closes its edge, and the trip ends before it.

    std::string vehicle(std::uint32_t unit) const { return id + "." + std::to_string(unit); }
};

/// Where vehicles of a kind wait for calls.
struct Station {
    core::EdgeIndex edge;
    traffic::VehicleKind kind = traffic::VehicleKind::ambulance;
    std::uint32_t units = 0;
};

/// Who is called, and who can go.
struct Calls {
    std::vector<PlacedCall> calls;  ///< By time, then by row in the file.
    std::vector<Station> stations;  ///< With at least one unit, in the order of the file.
};

/// The calls of a scenario on its network. Throws core::InputError with every problem: an unknown edge or
/// incident, coordinates off the network, an edge closed to emergency vehicles, a place that an incident
/// closes the way to, a call that no station can answer or reach, and more units called than wait.
Calls place_calls(const ScenarioConfig& config, const roads::Network& network,
                  const std::vector<PlacedIncident>& incidents);

/// Draws when each call comes in, to 0.01 s and after the `delay` of all events, and puts them in that order.
/// Every condition of a replication has the same times.
void draw_times(Calls& calls, core::Seconds delay, const core::KeyedRandom& random);

}  // namespace clearway::scenario
