#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"

namespace clearway::traffic {

/// A road that is blocked for a while, as it is.
struct Incident {
    core::EdgeIndex edge;
    std::vector<std::uint32_t> lanes;  ///< Numbers of the closed lanes, ascending, at least one.
    float position_m = 0.0F;           ///< Where it is, from the start of the edge.
    core::Seconds from;
    core::Seconds to;
    /// When everybody knows of it, after `from`; nothing: when a vehicle with a working sensor sees it.
    std::optional<core::Seconds> known_after;
    float speed_past_mps = 0.0F;    ///< Limit on the lanes that stay open; 0: none.
    bool emergency_passes = false;  ///< Closed for all but emergency vehicles.
};

/// What is known of an incident that lasts: until it is over, from when it became known.
struct KnownIncident {
    core::EdgeIndex edge;
    bool closed_to_emergency = false;  ///< No lane that an emergency vehicle may use is open.
    float speed_past_mps = 0.0F;       ///< Limit past it; 0: none.

    bool operator==(const KnownIncident&) const = default;
};

/// Whether one of them closes this edge to emergency vehicles.
inline bool closes(std::span<const KnownIncident> incidents, core::EdgeIndex edge) {
    return std::ranges::any_of(incidents, [edge](const KnownIncident& incident) {
        return incident.edge == edge && incident.closed_to_emergency;
    });
}

}  // namespace clearway::traffic
