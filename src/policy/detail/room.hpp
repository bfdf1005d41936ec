#pragma once

#include <unordered_map>
#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"
#include "traffic/belief.hpp"

namespace clearway::policy::detail {

/// How much of the beginning of each lane is free, as far as vehicles believed to stand tell. Of one moment.
class Room {
  public:
    /// Vehicles slower than `halted_mps` stand.
    Room(const roads::Network& network, const traffic::BelievedGraph& belief, double halted_mps);

    /// From the lane's beginning to the rear of the last vehicle that stands on it; the lane's length if none
    /// does. Not below 0.
    double at_start_of_m(core::LaneIndex lane) const;
    /// Whether every way of a link leads to a lane with less room than `least_m`. Links without a way lead
    /// nowhere, so they are not blocked.
    bool is_blocked(const std::vector<roads::SignalLink>& ways, double least_m) const;

  private:
    const roads::Network& network_;
    std::unordered_map<std::uint32_t, double> rear_m_;  ///< By lane: of the last standing vehicle.
};

}  // namespace clearway::policy::detail
