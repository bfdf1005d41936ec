#pragma once

#include <compare>
#include <cstdint>

#include "core/ids.hpp"

namespace clearway::prediction::detail {

/// Where a vehicle is on a lane. Ordered by lane, then along it; positions are not NaN.
struct VehicleOnLane {
    core::LaneIndex lane;
    float position_m = 0.0F;
    core::VehicleKey key;
    std::uint32_t index = 0;  ///< Of the vehicle, in a list of its user.

    bool operator==(const VehicleOnLane&) const = default;
    /// By hand: the default compares floats for a partial order, which makes sorting half as fast.
    std::weak_ordering operator<=>(const VehicleOnLane& other) const {
        if (lane != other.lane) return lane <=> other.lane;
        if (position_m < other.position_m) return std::weak_ordering::less;
        if (position_m > other.position_m) return std::weak_ordering::greater;
        return key != other.key ? key <=> other.key : index <=> other.index;
    }
};

}  // namespace clearway::prediction::detail
