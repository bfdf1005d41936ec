#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "drivers/config.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::drivers {

/// What the crew of an emergency vehicle does with its privileges: it passes red signals slowly and yielding,
/// and in the sublane model it drives between two lanes where it fits.
///
/// Part of the environment, not a policy: it sees the truth, as the crew does through the windscreen. Where a
/// policy gives an emergency vehicle a speed at the same moment, the later command holds. One per run;
/// single-threaded.
class Privilege {
  public:
    /// The network outlives the object.
    Privilege(const roads::Network& network, const PrivilegeConfig& config, traffic::LateralModel lateral);

    /// Appends the commands for this step, ordered by vehicle key. Does nothing without a privilege.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
              std::vector<traffic::Command>& commands);

    /// Appends the commands that end every use of a privilege.
    void restore_all(std::vector<traffic::Command>& commands);

  private:
    /// What a crew does now beyond ordinary driving.
    struct Use {
        bool passes_red = false;
        bool is_free = false;  ///< Leaves the middle of the lane.
        std::optional<double> speed_mps;
    };
    void judge_red(const truth::Snapshot& snapshot, const traffic::Roster& roster, core::VehicleIndex row,
                   Use& use) const;
    /// Returns how far to steer, m, positive to the left.
    double judge_gap(const truth::Snapshot& snapshot, const traffic::Roster& roster, core::VehicleIndex row,
                     Use& use) const;
    static void apply(core::VehicleKey key, const Use& wanted, Use& applied,
                      std::vector<traffic::Command>& commands);

    const roads::Network& network_;
    PrivilegeConfig config_;
    traffic::LateralModel lateral_;
    std::map<core::VehicleKey, Use> uses_;
};

}  // namespace clearway::drivers
