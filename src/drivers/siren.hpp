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
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::drivers {

/// How human drivers react to a siren behind them. The same in every condition of a study.
struct SirenConfig {
    double compliance = 0.0;  ///< Share of drivers that yield; 0 switches the reaction off.
    double audible_m = 60.0;
    double reaction_mean_s = 1.5;
    double reaction_deviation_s = 0.5;

    static constexpr auto fields() {
        return std::make_tuple(
            core::Field{"compliance", "1", &SirenConfig::compliance, 0.0, 1.0,
                        "Share of human drivers that yield to a siren", "0: scenarios v1 leave it out"},
            core::Field{"audible_m", "m", &SirenConfig::audible_m, 5.0, 500.0,
                        "Distance along the road at which drivers notice it",
                        "assumed: closed windows in town"},
            core::Field{"reaction_mean_s", "s", &SirenConfig::reaction_mean_s, 0.0, 10.0,
                        "Mean time between noticing and acting", "assumed: surprise reaction, 1.5 s"},
            core::Field{"reaction_deviation_s", "s", &SirenConfig::reaction_deviation_s, 0.0, 5.0,
                        "Standard deviation of it between drivers", "assumed: a third of the mean"});
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
    Siren(const roads::Network& network, const core::KeyedRandom& random, const SirenConfig& config);

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
    std::map<core::VehicleKey, Driver> drivers_;
};

}  // namespace clearway::drivers
