#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"
#include "policy/policy.hpp"

namespace clearway::testing {

/// What suits a policy in the scenes of every policy where the usual does not, and why. Those that need a
/// shoulder say so by their trait.
struct PolicyScenes {
    std::string policy = {};
    std::string reason = {};
    double to_line_m = 120.0;                 ///< From the emergency vehicle to the red signal.
    double speed_mps = 12.0;                  ///< Of the emergency vehicle there.
    std::vector<SceneVehicle> vehicles = {};  ///< There besides the usual ones.
    bool acts_in_helpful_scene = true;
    /// Its leases in the scene made against it have this reason; null where it must have none.
    const char* needless_lease = nullptr;
    bool ends_leases_within_60_s = true;
    /// False: it has the trait renews_requests, and nothing in the helpful scene is for it to ask.
    bool asks_vehicles = true;
};

/// Enters what suits a policy, as a constant of the file that tests it:
/// `const OwnScenes my_scenes{{.policy = "mine", .reason = "acts at speed", .speed_mps = 25.0}};`
class OwnScenes {
  public:
    explicit OwnScenes(PolicyScenes scenes);
};
/// All that were entered.
const std::vector<PolicyScenes>& all_own_scenes();
/// Those of a policy; the usual ones where none were entered.
PolicyScenes scenes_of(const std::string& policy);

/// The scene that every policy has something to do in, except those that need a shoulder: an emergency
/// vehicle before a red signal, automated vehicles 30 m ahead of it on its lane and 4 m behind its front on
/// the next one, queues of human drivers ahead of it and on the crossing street, and an automated vehicle
/// there.
void add_helpful_scene(ActuationBench& bench, const PolicyScenes& scenes = {});
/// The scene in which no policy has: traffic of all kinds, but the emergency vehicle is past the last signal
/// and alone.
void add_needless_scene(ActuationBench& bench);

/// Key of the emergency vehicle of these scenes.
core::VehicleKey emergency_key();

/// Runs a policy at a period of 0.5 s on what is believed of the bench's vehicles, with its leases carried
/// out. A message to a stretch of road reaches everybody there. Vehicles stand still. Checks that each lease
/// is legal, and keeps them all.
class PolicyRun {
  public:
    PolicyRun(std::unique_ptr<policy::Policy> policy, ActuationBench& bench)
        : policy_(std::move(policy)), bench_(bench) {}

    void run_for(double duration_s);
    void remove(core::VehicleKey vehicle);

    /// One line a lease.
    const std::vector<std::string>& leases() const { return leases_; }
    const std::vector<traffic::Command>& commands() const { return commands_; }
    /// Lifetime of the shortest request to a vehicle or to those on a stretch of road, s; nothing where there
    /// was none. What an emergency vehicle does itself is no request, nor is what serves none.
    std::optional<double> shortest_request_s() const { return shortest_request_s_; }

  private:
    void act();
    void note_request(const traffic::Lease& lease);
    std::vector<traffic::Lease> delivered(const std::vector<traffic::Lease>& leases) const;
    void expect_own_name(const std::string& name) const;
    void expect_legal(const traffic::Lease& lease);

    std::unique_ptr<policy::Policy> policy_;
    ActuationBench& bench_;
    int illegal_ = 0;  ///< Leases that failed the test; after a few it has said enough.
    std::vector<std::string> leases_;
    std::vector<traffic::Command> commands_;
    std::optional<double> shortest_request_s_;
};

/// Every vehicle and signal is as it was before the commands: whatever was set was given back.
void expect_all_given_back(const std::vector<traffic::Command>& commands);

}  // namespace clearway::testing
