#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "actuation/fakes.hpp"
#include "policy/policy.hpp"

namespace clearway::testing {

/// The scene that every policy has something to do in, except those that need a shoulder: an emergency
/// vehicle `to_line_m` before a red signal, automated vehicles ahead of it on its lane and beside it, queues
/// of human drivers ahead of it and on the crossing street, and an automated vehicle there.
void add_helpful_scene(ActuationBench& bench, double to_line_m = 120.0);
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
    void expect_legal(const traffic::Lease& lease);

    std::unique_ptr<policy::Policy> policy_;
    ActuationBench& bench_;
    std::vector<std::string> leases_;
    std::vector<traffic::Command> commands_;
    std::optional<double> shortest_request_s_;
};

/// Every vehicle and signal is as it was before the commands: whatever was set was given back.
void expect_all_given_back(const std::vector<traffic::Command>& commands);

}  // namespace clearway::testing
