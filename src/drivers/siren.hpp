#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/ids.hpp"
#include "core/random.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/siren.hpp"
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::drivers {

using traffic::SirenConfig;

/// How drivers react to a siren beside what a scenario says of them.
struct ReactionConfig {
    double fastest_reaction_s = 0.3;
    double memory_s = 3.0;
    double lane_request_s = 2.0;

    static constexpr auto fields() {
        using C = ReactionConfig;
        using core::Field;
        return std::make_tuple(
            Field{"fastest_reaction_s", "s", &C::fastest_reaction_s, 0.0, 10.0, "No driver reacts faster",
                  "assumed: a simple reaction"},
            Field{"memory_s", "s", &C::memory_s, 0.1, 60.0,
                  "A siren that was not heard for this long is forgotten", "assumed"},
            Field{"lane_request_s", "s", &C::lane_request_s, 0.1, 60.0,
                  "A driver tries for one lane this long before looking again", "assumed"});
    }
};

/// Human drivers who hear an emergency vehicle behind them on its way: after their reaction time those who
/// comply leave its lane as soon as their vehicle could change, into lanes that continue; those beside its
/// lane stay out of it. Who complies and how fast is drawn by driver, so it is the same in every condition.
/// Nothing is asked of automated vehicles: that is policy.
///
/// Environment, not policy: it sees the truth, as ears and mirrors do. One per run; one thread.
class Siren {
  public:
    /// The network outlives the object.
    Siren(const roads::Network& network, const core::KeyedRandom& random, const SirenConfig& config,
          const ReactionConfig& reaction = {});

    /// Appends what drivers do in this step, ordered by vehicle key. Does nothing for compliance 0.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
              const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);

    /// Appends the commands that give back every driver's own ways.
    void restore_all(std::vector<traffic::Command>& commands);

    /// Drivers who are reacting or about to.
    std::size_t aware() const { return drivers_.size(); }

  private:
    enum class Position : std::uint8_t { in_lane, beside };
    struct Driver {
        core::Seconds noticed;
        core::Seconds last_heard;
        Position position = Position::beside;
        bool is_holding = false;  ///< Keeps its lane by our command.
        core::Seconds asked_until{-1e9};
    };

    bool complies(core::VehicleKey driver) const;
    double reaction_s(core::VehicleKey driver) const;
    void hear(const truth::Snapshot& snapshot, const traffic::Roster& roster, core::VehicleIndex emergency);
    void act(core::VehicleKey key, Driver& driver, const truth::Snapshot& snapshot,
             const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);
    void leave_lane(core::VehicleKey key, Driver& driver, const truth::Snapshot& snapshot,
                    const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands);

    const roads::Network& network_;
    core::KeyedRandom random_;
    SirenConfig config_;
    ReactionConfig reaction_;
    std::map<core::VehicleKey, Driver> drivers_;
};

}  // namespace clearway::drivers
