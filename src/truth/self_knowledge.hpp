#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"

namespace clearway::truth {

/// Direction of a lane change; lane numbers grow to the left where traffic drives on the right.
enum class Neighbour : int { lower = -1, higher = 1 };

/// What a vehicle's own computer knows about the lane it is on.
struct LaneOutlook {
    std::uint32_t lane_number = 0;
    float drivable_m = 0.0F;  ///< How far the route can be followed on it without a lane change.
    int best_offset = 0;      ///< Lane changes needed for the route, 0 when it is a best lane.
};

/// What a vehicle knows about itself and could do now, and what a signal knows about itself and its
/// crossings. Only for `actuation` and `drivers`. Answers about a vehicle are nothing when it is not on the
/// road.
class SelfKnowledge {
  public:
    SelfKnowledge() = default;
    SelfKnowledge(const SelfKnowledge&) = delete;
    SelfKnowledge& operator=(const SelfKnowledge&) = delete;
    virtual ~SelfKnowledge() = default;

    /// Whether the vehicle could change to the neighbouring lane now: the lane exists, is allowed, and is
    /// free beside it.
    virtual std::optional<bool> could_change_lane(core::VehicleKey vehicle, Neighbour direction) const = 0;
    /// One entry per lane of the present edge, by lane number.
    virtual std::optional<std::vector<LaneOutlook>> lane_outlook(core::VehicleKey vehicle) const = 0;
    /// Highest speed the vehicle may and can drive here: min(road limit times its factor, own maximum).
    virtual std::optional<core::MetresPerSecond> allowed_speed(core::VehicleKey vehicle) const = 0;
    /// Whether a pedestrian is on a crossing.
    virtual bool has_pedestrian(core::LaneIndex crossing) const = 0;
    /// Id of the program that a signal runs.
    virtual std::string running_program(core::SignalIndex signal) const = 0;
};

}  // namespace clearway::truth
