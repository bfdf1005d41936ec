#pragma once

#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "traffic/lease.hpp"
#include "traffic/signal.hpp"

namespace clearway::view::detail {

/// A lease that a policy asked for and that has not expired.
struct LeaseInForce {
    traffic::Target target;
    traffic::Action action;
    double expiry_s = 0.0;
    std::string policy, reason;
    core::VehicleKey beneficiary;
    bool granted = false;  ///< Of a hold: the signal has shown green for all that it asks for.
};

/// Follows the leases of a run: those of each decision, until they expire or are replaced by the same
/// policy's next for the same target. What actuation makes of them is not known here.
class LeasesInForce {
  public:
    /// A hold of green that began, or that the signal granted.
    struct HoldChange {
        core::SignalIndex signal;
        core::VehicleKey beneficiary;
    };
    struct Changes {
        std::vector<HoldChange> requested, granted;
    };
    /// Takes the leases of a step (none where no decision was made) and what the signals show.
    Changes step(double time_s, std::span<const traffic::Lease> leases, const traffic::SignalStates& signals);

    /// Target, alternative of the action, policy, beneficiary.
    using Key = std::tuple<traffic::Target, std::size_t, std::string, core::VehicleKey>;
    const std::map<Key, LeaseInForce>& all() const { return leases_; }

  private:
    std::map<Key, LeaseInForce> leases_;
};

}  // namespace clearway::view::detail
