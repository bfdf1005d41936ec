#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/lease.hpp"
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::actuation {

/// Per part and action: how many leases were issued, refused (with the reason), renewed, and how many ended by expiry.
struct LeaseCounts {
    std::uint64_t issued = 0;
    std::uint64_t renewed = 0;
    std::uint64_t expired = 0;
    std::map<std::string, std::uint64_t> refused;  ///< Reason -> count.
};

/// Turns leases into commands: the only place that judges feasibility (as the vehicle itself would), lets leases expire,
/// runs signal transitions (yellow, all-red, hold cap, cool-down, back to the program) and restores what was changed on every way
/// out. One per run; one thread.
class Actuator {
  public:
    struct Config {
        double yellow_s = 3.0;      ///< facts: 3 s.
        double all_red_s = 1.5;     ///< facts: 1.5 s.
        double hold_cap_s = 60.0;   ///< Longest hold of one signal without a break.
        double cool_down_s = 10.0;  ///< Own program runs at least this long between holds.
        traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    };

    Actuator(const roads::Network& network, Config config);
    ~Actuator();
    Actuator(const Actuator&) = delete;
    Actuator& operator=(const Actuator&) = delete;

    /// Takes new leases (renewals of running ones included).
    void accept(std::span<const traffic::Lease> leases, core::Seconds now);

    /// Commands for this step. `snapshot` and `self` are the vehicles' knowledge of themselves.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster, const truth::SelfKnowledge& self,
              std::vector<traffic::Command>& commands);

    /// Commands that give back everything still held; afterwards nothing is.
    void restore_all(std::vector<traffic::Command>& commands);

    /// Number of leases in force.
    std::size_t active() const;
    /// By `part/action`.
    const std::map<std::string, LeaseCounts>& counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::actuation
