#pragma once

#include <optional>
#include <span>
#include <string>

#include "traffic/belief.hpp"
#include "traffic/lease.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::trace {

// The first thing in which two of a kind differ, in words: `vehicles[3].state.x_m: 12.5, then 12.25`. Nothing
// when every number is the same to the bit and every text the same. Rosters are compared by the vehicles that
// are named.

std::optional<std::string> difference(const truth::Snapshot& one, const truth::Snapshot& other);
std::optional<std::string> difference(const traffic::Observation& one, const traffic::Observation& other);
std::optional<std::string> difference(const traffic::BelievedGraph& one, const traffic::BelievedGraph& other);
std::optional<std::string> difference(std::span<const traffic::Lease> one,
                                      std::span<const traffic::Lease> other);

}  // namespace clearway::trace
