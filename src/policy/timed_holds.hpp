#pragma once

#include <map>
#include <span>
#include <vector>

#include "policy/policy.hpp"
#include "policy/signal_messages.hpp"

namespace clearway::policy {

/// Holds of signals from times that somebody else sets, in place of those that policies ask for: for trials
/// of these times. A request ends when its vehicle has passed.
class TimedHolds {
  public:
    explicit TimedHolds(const PolicyContext& context) : context_(context) {}

    /// Of this vehicle at this signal; a time that never comes: no hold.
    void hold_from(RequestKey request, core::Seconds time) { from_.insert_or_assign(request, time); }

    /// The leases without those that ask for the same, and where a decision was made, with its own; valid
    /// until the next call.
    std::span<const traffic::Lease> in_place_of(std::span<const traffic::Lease> leases,
                                                const traffic::BelievedGraph& belief, bool is_decision);

  private:
    void add(const traffic::BelievedGraph& belief);

    PolicyContext context_;
    std::map<RequestKey, core::Seconds> from_;
    std::vector<traffic::Lease> leases_;
};

}  // namespace clearway::policy
