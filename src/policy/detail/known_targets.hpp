#pragma once

#include <unordered_set>

#include "roads/network.hpp"
#include "traffic/belief.hpp"
#include "traffic/lease.hpp"

namespace clearway::policy::detail {

/// What leases of foreign code may name: vehicles that were believed once (they may have left since), and
/// signals, links and edges of the network, which follow each other in a way. Anything else is a mistake of
/// the code, such as a row in place of a key.
class KnownTargets {
  public:
    /// The network outlives the object.
    explicit KnownTargets(const roads::Network& network) : network_(network) {}

    void see(const traffic::BelievedGraph& belief);
    /// Throws python::PartError, without the part's name, for a lease of another target.
    void check(const traffic::Lease& lease) const;

  private:
    void check(core::VehicleKey vehicle) const;
    void check(core::SignalIndex signal, const traffic::Action& action) const;
    void check(const traffic::TakeRoute& way) const;
    void check_turn(core::EdgeIndex from, core::EdgeIndex to) const;

    const roads::Network& network_;
    std::unordered_set<std::uint64_t> vehicles_;
};

}  // namespace clearway::policy::detail
