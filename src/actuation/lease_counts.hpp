#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace clearway::actuation {

/// What became of the leases of one policy and action.
struct LeaseCounts {
    std::uint64_t issued = 0;  ///< New leases, refused ones included, renewals not.
    std::uint64_t renewed =
        0;  ///< Leases that prolonged or changed one of the same policy, target and beneficiary.
    std::uint64_t acted = 0;  ///< Leases that were carried out for a step at least.
    std::uint64_t expired =
        0;  ///< Ended by themselves: by time, or because the lane they named was left behind.
    std::map<std::string, std::uint64_t> refused;  ///< Reason -> leases refused for it at least once.
};

}  // namespace clearway::actuation
