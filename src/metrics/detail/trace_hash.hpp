#pragma once

#include <memory>
#include <span>
#include <string>

#include "traffic/lease.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Hash over everything that happened in a run: each snapshot in full, then the leases of that step. XXH3,
/// 128 bit, streamed. Does not depend on struct padding: every number is hashed by itself or in an array of
/// numbers.
class TraceHash {
  public:
    TraceHash();
    ~TraceHash();
    TraceHash(TraceHash&&) noexcept;
    TraceHash& operator=(TraceHash&&) noexcept;

    void add(const truth::Snapshot& snapshot);
    void add(std::span<const traffic::Lease> leases);
    /// Hash of everything added so far, 32 hex digits.
    std::string digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::metrics::detail
