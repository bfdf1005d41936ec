#pragma once

#include <list>
#include <optional>
#include <vector>

#include "actuation/lease_counts.hpp"
#include "core/ids.hpp"
#include "core/units.hpp"
#include "traffic/lease.hpp"

namespace clearway::actuation::detail {

/// Counts of a run.
class Ledger {
  public:
    LeaseCounts& of(const traffic::Lease& lease) { return counts_[{lease.policy, traffic::kind_of(lease)}]; }
    const LeaseLedger& counts() const { return counts_; }

  private:
    LeaseLedger counts_;
};

/// A lease in force.
struct HeldLease {
    traffic::Lease lease;
    /// Edge on which a lease about a lane or a stop line was first judged since its last renewal. It has no
    /// meaning on other edges.
    core::EdgeIndex edge;
    core::EdgeIndex granted_on;  ///< Edge on which a stop was found feasible; it stays so there.
    std::vector<traffic::Refusal> counted_refusals;  ///< Each reason is counted once per lease.
    bool counted_act = false;
    bool served = false;                                ///< A hold that is carried out or in transition.
    std::optional<core::Seconds> since = std::nullopt;  ///< When it was first judged.
};

/// Leases in force for one target, competing for the same thing; best first: by priority, then by age. A
/// lease of the same policy for the same beneficiary is a renewal and keeps its place.
class LeaseQueue {
  public:
    void offer(const traffic::Lease& lease, Ledger& ledger);
    /// Ends the leases that have expired.
    void expire(core::Seconds now, Ledger& ledger);
    /// Counts a refusal, once per lease and reason. The lease stays and is judged again.
    static void refuse(HeldLease& held, traffic::Refusal reason, Ledger& ledger);
    /// Counts that a lease is carried out, once per lease.
    static void act(HeldLease& held, Ledger& ledger);
    /// Counts a refusal and ends all leases.
    void drop_all(traffic::Refusal reason, Ledger& ledger);
    /// Ends the best lease without counting a refusal: what it asked for is over.
    void end_best(Ledger& ledger);
    void clear() { held_.clear(); }

    HeldLease* best() { return held_.empty() ? nullptr : &held_.front(); }
    std::list<HeldLease>& all() { return held_; }
    const std::list<HeldLease>& all() const { return held_; }
    std::size_t size() const { return held_.size(); }
    bool empty() const { return held_.empty(); }

  private:
    std::list<HeldLease> held_;
};

inline constexpr double time_tolerance_s = core::clock_tolerance_s;

}  // namespace clearway::actuation::detail
