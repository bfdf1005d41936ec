#pragma once

#include <span>
#include <string>

#include "core/running_hash.hpp"
#include "traffic/lease.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Hash over everything that happened in a run: each snapshot in full, then the leases of that step. XXH3,
/// 128 bit, streamed. Ways that were only considered are left out, because they change
/// nothing. Does not depend on struct padding: every number is hashed by itself or in an array of
/// numbers.
class TraceHash {
  public:
    void add(const truth::Snapshot& snapshot);
    void add(std::span<const traffic::Lease> leases);
    /// Hash of everything added so far, 32 hex digits.
    std::string digest() const { return hash_.digest(); }

  private:
    core::RunningHash hash_;
};

}  // namespace clearway::metrics::detail
