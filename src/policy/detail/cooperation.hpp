#pragma once

#include <functional>
#include <map>
#include <vector>

#include "policy/detail/view.hpp"

namespace clearway::policy::detail {

/// Pulling aside goes before changing lanes: a vehicle that stands in a queue cannot change lanes.
inline constexpr int aside_priority = 1;

/// Vehicles that were asked to stop beside the road for an emergency vehicle. There, nobody sees them any
/// more, so the part remembers where it asked them, and renews the request until the emergency vehicle has
/// passed.
class AsideMemory {
  public:
    /// Forgets those asked for emergency vehicles that are no longer believed.
    void keep_only(const std::vector<traffic::BelievedVehicle>& emergencies);
    void note(const traffic::BelievedVehicle& emergency, const traffic::BelievedVehicle& asked);
    /// Renews the requests to vehicles that are not believed any more as long as they are still in the way,
    /// by where they were asked; forgets the others.
    void renew(const View& view, const traffic::BelievedVehicle& emergency,
               const std::function<bool(const traffic::MotionState&)>& in_the_way, LeaseWriter& write);

  private:
    std::map<core::VehicleKey, std::map<core::VehicleKey, traffic::MotionState>> asked_;
};

}  // namespace clearway::policy::detail
