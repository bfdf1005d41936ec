#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace clearway::actuation {

/// Outcomes of the leases of one policy and action.
struct LeaseCounts {
    std::uint64_t issued = 0;  ///< New leases, including refused ones, without renewals.
    /// Leases that extended or changed one of the same policy, target and beneficiary.
    std::uint64_t renewed = 0;
    std::uint64_t acted = 0;  ///< Leases that were carried out for at least one step.
    /// Ended by themselves: by time, or because the vehicle left the edge that they were about.
    std::uint64_t expired = 0;
    std::map<std::string, std::uint64_t> refused;  ///< By reason: leases refused for it at least once.
};

}  // namespace clearway::actuation
