#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "policy/policy.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::testing {

/// What a policy does in one moment on a drawn road.
class StraightRoad {
  public:
    explicit StraightRoad(std::string_view drawing) : scene(drawing) {}

    /// Leases of one call, with everything known; emergency vehicles know themselves.
    const std::vector<traffic::Lease>& act(policy::Policy& policy) {
        traffic::BelievedGraph belief = support::perfect_belief(scene);
        belief.own_states.clear();
        for (const traffic::BelievedVehicle& vehicle : belief.vehicles) {
            if (vehicle.vehicle_class == traffic::VehicleClass::emergency)
                belief.own_states.push_back(vehicle);
        }
        leases_.clear();
        policy.act(belief, leases_);
        return leases_;
    }

    /// The last call's action of one kind for a vehicle.
    template <class Action>
    std::optional<Action> asked(const std::string& id) const {
        for (const traffic::Lease& lease : leases_) {
            const auto* vehicle = std::get_if<core::VehicleKey>(&lease.target);
            const auto* action = std::get_if<Action>(&lease.action);
            if (vehicle != nullptr && action != nullptr && *vehicle == scene.key(id)) return *action;
        }
        return std::nullopt;
    }
    std::optional<double> asked_speed(const std::string& id) const {
        const auto drive = asked<traffic::DriveAt>(id);
        return drive ? std::optional(drive->speed.value) : std::nullopt;
    }
    std::optional<std::uint32_t> asked_lane(const std::string& id) const {
        const auto change = asked<traffic::ChangeLane>(id);
        return change ? std::optional(change->lane_number) : std::nullopt;
    }

    void stop(std::initializer_list<const char*> ids) {
        for (const char* id : ids)
            scene.set_speed(id, core::MetresPerSecond(0.0));
    }

    support::Scene scene;

  private:
    std::vector<traffic::Lease> leases_;
};

}  // namespace clearway::testing
