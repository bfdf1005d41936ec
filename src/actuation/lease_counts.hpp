#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string_view>

#include "traffic/lease.hpp"
#include "traffic/refusal.hpp"

namespace clearway::actuation {

/// Whose leases, and for what.
struct LeaseSort {
    std::string_view policy;  ///< Static storage.
    traffic::LeaseKind kind = traffic::LeaseKind::drive_at;

    auto operator<=>(const LeaseSort&) const = default;
};

/// Outcomes of the leases of one sort.
struct LeaseCounts {
    std::uint64_t issued = 0;  ///< New leases, including refused ones, without renewals.
    /// Leases that extended or changed one of the same policy, target and beneficiary.
    std::uint64_t renewed = 0;
    std::uint64_t acted = 0;  ///< Leases that were carried out for at least one step.
    /// Ended by themselves: by time, or because the vehicle left the edge that they were about.
    std::uint64_t expired = 0;
    std::map<traffic::Refusal, std::uint64_t> refused;  ///< Leases refused for this at least once.
};
using LeaseLedger = std::map<LeaseSort, LeaseCounts>;

}  // namespace clearway::actuation
