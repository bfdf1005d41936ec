#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "roads/route.hpp"
#include "traffic/belief.hpp"
#include "traffic/lease.hpp"

namespace clearway::policy::detail {

/// A vehicle believed ahead of another on its route.
struct VehicleAhead {
    const traffic::BelievedVehicle* vehicle = nullptr;
    double distance_m = 0.0;  ///< Front to front, along the route; negative for one behind.
};

/// Questions that several policies ask of a belief. Refers to the belief and the network; use it within one
/// `act`.
class View {
  public:
    View(const roads::Network& network, const traffic::BelievedGraph& belief)
        : network_(network), belief_(belief) {}

    const roads::Network& network() const { return network_; }
    const traffic::BelievedGraph& belief() const { return belief_; }

    /// Every emergency vehicle on the road that has a place on its route, as it knows itself, or else as
    /// believed. Ordered by key.
    std::vector<traffic::BelievedVehicle> emergency_vehicles() const;

    /// The vehicle's route; empty when it is not registered.
    roads::Route route_of(core::VehicleKey vehicle) const;
    /// Whether lane and route are known and fit together, so that questions about the route may be asked.
    bool is_on_route(const traffic::BelievedVehicle& vehicle) const;
    /// What is registered of a vehicle; of a typical one when it is not.
    const traffic::VehicleInfo& info_of(const traffic::BelievedVehicle& vehicle) const;
    /// Highest speed that the road and the vehicle allow; 0 for an unregistered vehicle or without a lane.
    core::MetresPerSecond allowed_speed(const traffic::BelievedVehicle& vehicle) const;
    /// The edge a vehicle is on; empty without a lane.
    std::optional<core::EdgeIndex> edge_of(const traffic::BelievedVehicle& vehicle) const;
    std::uint32_t lane_number(const traffic::BelievedVehicle& vehicle) const {
        assert(vehicle.state.lane.exists());
        return network_.lane(vehicle.state.lane).number;
    }

    /// Vehicles believed ahead on the route of `vehicle`, nearest first, itself left out.
    std::vector<VehicleAhead> vehicles_ahead(const traffic::BelievedVehicle& vehicle,
                                             core::Metres horizon) const;

    /// Vehicles believed behind on the edges of the route that `vehicle` has passed, whose fronts are up to
    /// `reach` behind its own, nearest first; one beside it whose front is level or further ahead is left
    /// out.
    std::vector<VehicleAhead> vehicles_behind(const traffic::BelievedVehicle& vehicle,
                                              core::Metres reach) const;

    /// Whether a place lies ahead on the route of `vehicle`, within `horizon`.
    bool is_ahead(const traffic::BelievedVehicle& vehicle, const traffic::MotionState& place,
                  core::Metres horizon) const {
        return roads::distance_ahead(network_, route_of(vehicle.key), vehicle.state, place, horizon)
            .has_value();
    }

    /// Whether lane `number` of the present edge exists, is open to the vehicle, and continues along its
    /// route for over 300 m or to the route's end. Actuation applies the same rule.
    bool may_use_lane(const traffic::BelievedVehicle& vehicle, std::uint32_t number) const;
    /// The neighbouring lanes that `may_use_lane` allows, the outer (lower) one first.
    std::vector<std::uint32_t> usable_neighbours(const traffic::BelievedVehicle& vehicle) const;
    /// The one of them with fewer vehicles of `others` less than `side_room_m` before or behind; the outer
    /// one if equal.
    std::optional<std::uint32_t> way_out(const traffic::BelievedVehicle& vehicle,
                                         const std::vector<VehicleAhead>& others, double side_room_m) const;

  private:
    const roads::Network& network_;
    const traffic::BelievedGraph& belief_;
};

/// Writes the leases of one policy.
class LeaseWriter {
  public:
    /// `policy` has static storage; `period` is the time between two decisions. A lease that is not renewed
    /// lives `lease_s`, or two periods if those are longer. See traffic::Lease for `priority`.
    LeaseWriter(const char* policy, core::Seconds period, core::Seconds now,
                std::vector<traffic::Lease>& leases, double lease_s = 0.0, int priority = 0)
        : policy_(policy),
          usual_(std::max(lease_s, two_periods(period).value)),
          now_(now),
          leases_(leases),
          priority_(priority) {}

    /// Just long enough for a lease that every decision renews.
    static core::Seconds two_periods(core::Seconds period) { return core::Seconds(2.0 * period.value); }

    /// `reason` has static storage; `beneficiary` is the emergency vehicle served.
    void add(traffic::Target target, traffic::Action action, const char* reason, core::VehicleKey beneficiary,
             std::optional<core::Seconds> lasting = std::nullopt) {
        assert(*reason != '\0' && lasting.value_or(usual_).value > 0.0);
        leases_.push_back({target, std::move(action), now_ + lasting.value_or(usual_), priority_, policy_,
                           reason, beneficiary});
    }

  private:
    const char* policy_;
    core::Seconds usual_;
    core::Seconds now_;
    std::vector<traffic::Lease>& leases_;
    int priority_;
};

}  // namespace clearway::policy::detail
