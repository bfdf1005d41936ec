#pragma once

#include <map>
#include <vector>

#include "core/ids.hpp"
#include "core/random.hpp"
#include "core/units.hpp"
#include "drivers/config.hpp"
#include "drivers/detail/drawn_reaction.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::drivers {

/// Human drivers on the route of an emergency vehicle who hear it behind them. After their reaction time,
/// those who comply leave its lane as soon as they can, into a lane that continues; those in other lanes stay
/// out of it. Compliance and reaction time are drawn per driver, so they are the same in every condition.
/// Automated vehicles are left to the policies.
///
/// Part of the environment, not a policy: it sees the truth, as drivers do with ears and mirrors. One per
/// run; single-threaded.
class Siren {
  public:
    /// The network outlives the object.
    Siren(const roads::Network& network, const core::KeyedRandom& random, const SirenConfig& config);

    /// Appends the drivers' commands for this step, ordered by vehicle key. Does nothing if compliance is 0.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
              const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);

    /// Appends the commands that restore every driver's own behaviour.
    void restore_all(std::vector<traffic::Command>& commands);

    /// Number of drivers who react or are about to.
    std::size_t aware() const { return drivers_.size(); }

  private:
    enum class Position : std::uint8_t { in_lane, beside };
    struct Driver {
        core::Seconds noticed;
        core::Seconds last_heard;
        Position position = Position::beside;
        bool is_holding = false;  ///< Holds its lane because of our command.
        core::Seconds asked_until{-1e9};
    };

    void hear(const truth::Snapshot& snapshot, const traffic::Roster& roster, core::VehicleIndex emergency);
    void act(core::VehicleKey key, Driver& driver, const truth::Snapshot& snapshot,
             const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);
    void leave_lane(core::VehicleKey key, Driver& driver, const truth::Snapshot& snapshot,
                    const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);

    const roads::Network& network_;
    SirenConfig config_;
    detail::DrawnReaction reactions_;
    std::map<core::VehicleKey, Driver> drivers_;
};

}  // namespace clearway::drivers
